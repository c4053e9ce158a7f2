#pragma once

#include "nerf/field/libtorch.h"

namespace nerf {

// Added to a density network's output before the exponential, so that training starts with low
// density: with density 1 a ray would be opaque before it has crossed the scene.
inline constexpr double kLogDensityBias = -1.0;

// Density from a network's output [S], in 1 / unit of contracted space. Differentiable.
torch::Tensor ActivateDensity(const torch::Tensor& network_output);

// The factor by which contraction shortens radial lengths: 1 inside the unit ball, and
// 1/r^2 = (2 - |y|)^2 outside, for a contracted point y.
//   positions_in_cube  [S,3] -> [S]
// Differentiable.
torch::Tensor RadialShrinkage(const torch::Tensor& positions_in_cube);

}  // namespace nerf
