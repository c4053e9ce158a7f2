#pragma once

#include <cstdint>
#include <span>

#include "nerf/effects/background_map.h"

namespace nerf {

// What training of a background starts from. Surroundings without end look the same in one
// direction, whichever photograph shows them; what stands before them does not. So each texel
// becomes the median of the largest group of photographs that agree on it, two at least; where none
// agree, what a map of half the rows has there that is made in the same way. In the coarsest one
// (16 rows or fewer) these texels are the mean of those beside them. Where photographs hardly ever
// agree, as their exposures differ, it has the median of them all.
//   photograph  [R] which
//   direction   [R,3] unit vectors
//   rgb         [R,3] in the encoding of the map
void StartFromPhotographs(std::span<const std::int64_t> photograph,
                          std::span<const float> direction, std::span<const float> rgb,
                          BackgroundMap& map);

}  // namespace nerf
