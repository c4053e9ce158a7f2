#pragma once

#include <string>

#include "nerf/field/libtorch.h"
#include "nerf/field/radiance_field.h"
#include "nerf/geometry/rays.h"
#include "nerf/sampling/packed_samples.h"

namespace nerf {

// Names the first ray with a non-finite value, and the stage that produced it: density, colour,
// compositing or the colours of the photograph.
//   rgb, target  [R,3]
std::string DescribeNonFinite(const PackedSamples& samples, const FieldOutput& field,
                              const torch::Tensor& rgb, const torch::Tensor& target);

}  // namespace nerf
