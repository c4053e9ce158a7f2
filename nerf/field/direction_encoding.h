#pragma once

#include "nerf/field/libtorch.h"
#include "nerf/kernels/direction_encoding.h"

namespace nerf {

using kernels::kDirectionFeatures;

// The real spherical harmonics up to degree 3 of unit directions.
// Source: Sloan 2013, "Efficient Spherical Harmonic Evaluation", appendix A2.
//   directions  [R,3] unit vectors
//   returns     [R,16]
// Differentiable in the directions. Throws c10::Error on a shape mismatch.
torch::Tensor EncodeDirections(const torch::Tensor& directions);

}  // namespace nerf
