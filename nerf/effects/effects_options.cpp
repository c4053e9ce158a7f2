#include "nerf/effects/effects_options.h"

#include <algorithm>
#include <cmath>

#include "sfm/input_error.h"

namespace nerf {

void BackgroundOptions::Check() const {
  if (resolution >= 2 && resolution <= 1024) return;
  throw sfm::InputError("config: effects.background.resolution is {}; use 2 to 1024", resolution);
}

RobustOptions RobustOptions::At(double progress) const {
  return {scale * std::pow(100.0, std::clamp(1 - 2 * progress, 0.0, 1.0))};
}

void RobustOptions::Check() const {
  if (scale > 0) return;
  throw sfm::InputError("config: effects.robust.scale is {}; use more than 0", scale);
}

void DepthOptions::Check() const {
  if (!(share >= 0 && share <= 0.5)) {
    throw sfm::InputError("config: effects.depth.share is {}; use 0 to 0.5", share);
  }
  if (!(weight >= 0)) {
    throw sfm::InputError("config: effects.depth.weight is {}; use 0 or more", weight);
  }
  if (!(delta > 0)) {
    throw sfm::InputError("config: effects.depth.delta is {}; use more than 0", delta);
  }
}

void PosesOptions::Check() const {
  if (rate >= 0 && rate <= 1) return;
  throw sfm::InputError("config: effects.poses.rate is {}; use 0 to 1", rate);
}

void FootprintOptions::Check() const {
  if (pixels >= 0 && pixels <= 8) return;
  throw sfm::InputError("config: effects.footprint.pixels is {}; use 0 to 8", pixels);
}

void EffectsOptions::Check() const {
  if (poses) poses->Check();
  if (footprint) footprint->Check();
  if (background) background->Check();
  if (masks) masks->Check();
  if (robust) robust->Check();
  if (depth) depth->Check();
}

}  // namespace nerf
