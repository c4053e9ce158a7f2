#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/geometry/rays.h"

namespace nerf {

// How a loss changes with the rays on which samples stand, at fixed distances along them.

// The way there, for autograd: where samples stand in the unit cube.
//   origin, direction  [R,3]    ray  [S] int64    t  [S]    returns [S,3]
// Differentiable in origin and direction.
torch::Tensor SamplePositions(const torch::Tensor& origin, const torch::Tensor& direction,
                              const torch::Tensor& ray, const torch::Tensor& t);

// The way back, by hand.
struct RayGradient {
  std::vector<float> origin, direction;  // [R,3]
};
// Adds what samples pass on to the rays that they stand on.
//   ray, t          [S]
//   dL_dposition    [S,3] through the encoding, in the unit cube
//   dL_dlog_sigma   [S] through the density, which outside the unit ball falls as 1/r^2
void AddToRays(const RayBatch& rays, std::span<const std::int64_t> ray, std::span<const float> t,
               std::span<const float> dL_dposition, std::span<const float> dL_dlog_sigma,
               RayGradient& gradient);

}  // namespace nerf
