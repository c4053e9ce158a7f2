#pragma once

#include <optional>

#include "nerf/effects/effect.h"

namespace nerf {

// Matter beyond what the cameras look at, to any distance, in contracted space
// (nerf/sampling/contraction.h). Without it rays end at the unit ball about the scene, in which
// nothing is contracted (RangeOfRay in nerf/sampling/ray_marcher.h).
struct UnboundedOptions {
  template <class Self, class Visitor>
  static void Options(Self&, Visitor&&) {}
};

// Whether there is anything beyond a ball about what the cameras look at.
//   hull  of photographs with alpha: a ball about what alpha leaves, radii; nullopt: it may reach
//   far
Verdict JudgeUnbounded(const std::optional<Ball>& hull);
//   shares  of photographs without alpha
//   may_learn_background  else contracted space must hold what is far
Verdict JudgeUnbounded(const PointShares& shares, bool may_learn_background);

extern const EffectDescriptor kUnbounded;

}  // namespace nerf
