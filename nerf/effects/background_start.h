#pragma once

#include <cstdint>
#include <span>

#include "nerf/effects/background_map.h"

namespace nerf {

// Initializes a background map from the training photographs. A background at infinity has the
// same colour in a given direction in every photograph; objects in front of it do not. So each
// texel is the median of the largest group of photographs (at least two) that agree on its colour.
// Texels without agreement are interpolated from a map of half the rows, initialized the same way;
// in the coarsest map (16 rows or fewer) they are filled from their neighbours. Where photographs
// hardly ever agree, because exposures differ, the coarsest map has the median of all photographs.
//   photograph  [R] index of the photograph of each ray
//   direction   [R,3] unit vectors
//   rgb         [R,3] in the encoding of the map
//   map         rows and encoding are given; raw is the result
void InitializeBackground(std::span<const std::int64_t> photograph,
                          std::span<const float> direction, std::span<const float> rgb,
                          BackgroundMap& map);

}  // namespace nerf
