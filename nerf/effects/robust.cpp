#include "nerf/effects/robust.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"

namespace nerf {

RobustOptions RobustOptions::At(double progress) const {
  return {scale * std::pow(100.0, std::clamp(1 - 2 * progress, 0.0, 1.0))};
}

void RobustOptions::Check() const {
  if (scale > 0) return;
  throw InputError("config: effects.robust.scale is {}; use more than 0", scale);
}

}  // namespace nerf
