#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"
#include "nerf/geometry/rays.h"
#include "nerf/kernels/hash_encoding.h"

namespace nerf {

// A pixel does not see a point but a patch, which grows with the distance. What is finer than the
// patch is averaged in it: each level of the encoding counts by how much of its cells the patch
// leaves. Without it a field that is seen from near and far must show both the sharp and the
// averaged with one value at each place. Source: Barron et al. 2023, "Zip-NeRF", section 3
// (downweighting by erf), with one Gaussian at each sample's place.
struct AntiAliasingOptions {
  // More than one, for a sample in the middle of a pixel stands for all of it: 4 was best of 1, 2,
  // 4 and 8 on validation photographs, with 8.
  double pixels = 4;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("pixels", o.pixels, "pixels", Between(0, 8), "width that a pixel averages; 0: a point");
  }
};

// The standard deviation of the patch at each sample, in the unit cube: pixels / sqrt(12) times
// spread times t, as the contraction shrinks lengths across the radius.
//   ray, t  [S]; rays have a spread, else the patches are points
std::vector<float> Footprints(const RayBatch& rays, std::span<const std::int64_t> ray,
                              std::span<const float> t, const AntiAliasingOptions& options);

// The weight of each level of the encoding, given the patch that a sample stands for: erf(1 /
// (sqrt(8) footprint resolution)), 1 for a point.
//   footprint  [S]    returns [S, levels]
std::vector<float> AntiAliasingWeights(const kernels::HashGridLayout& layout,
                                       std::span<const float> footprint);

// How much the scale changes at which photographs show the same point: what is one pixel from far
// away is many from nearby. Undecided where no point has a track.
Verdict JudgeAntiAliasing(const PosedImages& posed);

extern const EffectDescriptor kAntiAliasing;

}  // namespace nerf
