#pragma once

#include <array>
#include <span>

#include "nerf/data/image.h"

namespace nerf {

// Photographs whose exposure or white balance differ (Exposure).
struct ExposureOptions {};

// The gain for each channel that takes a rendering closest to a photograph, by least squares over
// the pixels that are neither black nor white to the end of their scale; 1 where there is none.
// Photographs that training never saw are compared so where exposures differ: theirs is known to
// nobody else. Three numbers for a whole photograph.
//   rendered, photograph  [R,3]
std::array<float, 3> FitGains(std::span<const float> rendered, std::span<const float> photograph,
                              ColorEncoding encoding);

// Multiplies each pixel, [R,3], by the gains.
void ApplyGains(const std::array<float, 3>& gains, std::span<float> rgb);

}  // namespace nerf
