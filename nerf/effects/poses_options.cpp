#include "nerf/effects/poses_options.h"

#include "nerf/base/input_error.h"

namespace nerf {

void PosesOptions::Check() const {
  if (rate >= 0 && rate <= 1) return;
  throw InputError("config: effects.poses.rate is {}; use 0 to 1", rate);
}

}  // namespace nerf
