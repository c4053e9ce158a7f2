#include "nerf/effects/effects.h"

namespace nerf {

void EffectsOptions::Check() const {
  if (poses) poses->Check();
  if (footprint) footprint->Check();
  if (background) background->Check();
  if (masks) masks->Check();
  if (robust) robust->Check();
  if (depth) depth->Check();
}

}  // namespace nerf
