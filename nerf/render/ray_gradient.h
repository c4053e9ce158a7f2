#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/geometry/rays.h"

namespace nerf {

// The dependence of a loss on the rays, for samples at fixed distances along them.

// Forward pass, for autograd: the positions of samples in the unit cube.
//   origin, direction  [R,3]    ray  [S] int64    t  [S]    returns [S,3]
// Differentiable in origin and direction.
torch::Tensor SamplePositions(const torch::Tensor& origin, const torch::Tensor& direction,
                              const torch::Tensor& ray, const torch::Tensor& t);

// Backward pass, without autograd.
struct RayGradient {
  std::vector<float> origin, direction;  // [R,3]
};
// Adds the gradients of samples to those of their rays.
//   ray, t          [S]
//   dL_dposition    [S,3] through the encoding, in the unit cube
//   dL_dlog_sigma   [S] through RadialShrinkage of the density outside the unit ball
void AddToRays(const RayBatch& rays, std::span<const std::int64_t> ray, std::span<const float> t,
               std::span<const float> dL_dposition, std::span<const float> dL_dlog_sigma,
               RayGradient& gradient);

}  // namespace nerf
