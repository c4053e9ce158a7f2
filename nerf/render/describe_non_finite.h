#pragma once

#include <string>

#include "nerf/field/libtorch.h"
#include "nerf/field/radiance_field.h"
#include "nerf/geometry/rays.h"
#include "nerf/sampling/packed_samples.h"

namespace nerf {

// Names the first ray whose loss is not finite, and the stage that spoilt it: density, colour,
// compositing or the photograph's own colours.
//   rgb, target  [R,3]
std::string DescribeNonFinite(const PackedSamples& samples, const FieldOutput& field,
                              const torch::Tensor& rgb, const torch::Tensor& target);

}  // namespace nerf
