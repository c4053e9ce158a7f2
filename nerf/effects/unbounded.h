#pragma once

#include <optional>

#include "nerf/effects/effect.h"
#include "nerf/geometry/ball.h"

namespace nerf {

struct PointShares;

// Surroundings at any distance, in contracted space (nerf/sampling/contraction.h). Without it rays
// end at the unit ball around the scene, inside which nothing is contracted (RangeOfRay in
// nerf/sampling/ray_marcher.h).
struct UnboundedOptions {
  template <class Self, class Visitor>
  static void Options(Self&, Visitor&&) {}
};

// On where the scene extends beyond a ball around what the cameras look at.
//   hull  for photographs with alpha: a ball around the visual hull, radii; nullopt: unbounded
Verdict JudgeUnbounded(const std::optional<Ball>& hull);
//   shares                for photographs without alpha
//   may_learn_background  if false, contracted space has to represent distant points
Verdict JudgeUnbounded(const PointShares& shares, bool may_learn_background);

extern const EffectDescriptor kUnboundedEffect;

}  // namespace nerf
