#pragma once

#include "nerf/field/libtorch.h"

namespace nerf {

// Added to what a density network says before the exponential. Starts thin: with density 1 a ray
// would be opaque before it has crossed the scene.
inline constexpr double kLogDensityBias = -1.0;

// What a network says, as a density in 1 / unit of contracted space.
torch::Tensor ActivateDensity(const torch::Tensor& network_output);

// How much shorter lengths are in contracted space, along the radius: 1 inside the unit ball, and
// 1/r^2 = (2 - |y|)^2 outside, for a contracted point y.
//   positions_in_cube  [S,3] -> [S]
torch::Tensor RadialShrinkage(const torch::Tensor& positions_in_cube);

}  // namespace nerf
