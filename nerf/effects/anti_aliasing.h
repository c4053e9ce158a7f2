#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"
#include "nerf/geometry/rays.h"
#include "nerf/kernels/hash_encoding.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// A pixel averages a patch of the surface that grows with the distance (its footprint). Levels of
// the hash encoding whose cells are smaller than the footprint get less weight. Without it the
// field has one value per point for both close-up and distant photographs. Source: Barron et al.
// 2023, "Zip-NeRF", section 3 (downweighting by erf), with one Gaussian per sample.
struct AntiAliasingOptions {
  // More than 1, because one sample at the pixel centre represents the whole pixel: of 1, 2, 4 and
  // 8, the values 4 and 8 were best on validation photographs.
  double pixels = 4;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("pixels", o.pixels, "pixels", Between(0, 8), "width that a pixel averages; 0: a point");
  }
};

// The standard deviation of the footprint at each sample, in units of the unit cube: pixels /
// sqrt(12) * spread * t, scaled as the contraction scales lengths perpendicular to the radius.
//   ray, t   [S]
//   returns  [S]; 0 where the rays have no spread
// Not differentiable.
std::vector<float> Footprints(const RayBatch& rays, std::span<const std::int64_t> ray,
                              std::span<const float> t, const AntiAliasingOptions& options);

// The weight of each level of the encoding for a sample's footprint: erf(1 / (sqrt(8) footprint
// resolution)), which is 1 for a footprint of 0.
//   footprint  [S]    returns [S, levels]
std::vector<float> AntiAliasingWeights(const kernels::HashGridLayout& layout,
                                       std::span<const float> footprint);

// Measures by how much the scales (distance over focal length) at which photographs show the same
// point differ. Undecided where no point has a track.
Verdict JudgeAntiAliasing(const PosedImages& posed);

extern const EffectDescriptor kAntiAliasingEffect;

}  // namespace nerf
