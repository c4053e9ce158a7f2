#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/kernels/hash_encoding.h"

namespace nerf {

// A pixel does not see a point but a patch, which grows with the distance. What is finer than the
// patch is averaged in it: each level of the encoding counts by how much of its cells the patch
// leaves. Without it a field that is seen from near and far must show both the sharp and the
// averaged with one value at each place. Source: Barron et al. 2023, "Zip-NeRF", section 3
// (downweighting by erf), with one Gaussian at each sample's place.
struct FootprintOptions {
  // The width of what a pixel averages; 0: a point. More than one, for a sample in the middle of a
  // pixel stands for all of it: 4 was best of 1, 2, 4 and 8 on photographs for validation, with 8.
  double pixels = 4;

  void Check() const;
};

// The standard deviation of the patch at each sample, in the unit cube: pixels / sqrt(12) times
// spread times t, as the contraction shrinks lengths across the radius.
//   ray, t  [S]; rays have a spread, else the patches are points
std::vector<float> Footprints(const RayBatch& rays, std::span<const std::int64_t> ray,
                              std::span<const float> t, const FootprintOptions& options);

// By what the patches multiply what levels give: erf(1 / (sqrt(8) footprint resolution)), 1 for a
// point.
//   footprint  [S]    returns [S, levels]
std::vector<float> LevelShares(const kernels::HashGridLayout& layout,
                               std::span<const float> footprint);

}  // namespace nerf
