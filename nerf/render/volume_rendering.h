#pragma once

#include "nerf/field/libtorch.h"

namespace nerf {

struct VolumeRendering {
  torch::Tensor rgb;      // [R,3]
  torch::Tensor opacity;  // [R] in [0,1]
  torch::Tensor depth;    // [R] sum of w_i t_i; divided by the opacity it is the expected depth
};

// Composites samples front to back: w_i = T_i (1 - exp(-sigma_i dt_i)).
// Source: Max 1995; Mildenhall et al. 2020. See nerf/kernels/volume_rendering.h for numerics.
//   ray_begin   [R+1] int64, first sample of each ray; the last entry is S
//   sigma       [S]   1 / scene unit, >= 0
//   radiance    [S,3]
//   dt, t       [S]   scene units; length (0 or more) and distance of each interval, front to back
//   background  [R,3]
//   returns     for an empty ray the background, opacity 0, depth 0
// Differentiable in sigma, radiance and background, not in the sample positions. float or double.
// Throws c10::Error on a shape or type mismatch, and with the ray's index where dt is negative, t
// decreases, or either is NaN.
VolumeRendering RenderVolume(const torch::Tensor& ray_begin, const torch::Tensor& sigma,
                             const torch::Tensor& radiance, const torch::Tensor& dt,
                             const torch::Tensor& t, const torch::Tensor& background);

// The weights w_i only.
//   returns  [S]
// Differentiable in sigma. Throws c10::Error on a shape mismatch.
torch::Tensor RenderWeights(const torch::Tensor& ray_begin, const torch::Tensor& sigma,
                            const torch::Tensor& dt);

}  // namespace nerf
