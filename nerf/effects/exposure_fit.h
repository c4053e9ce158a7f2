#pragma once

#include <array>
#include <span>
#include <vector>

#include "nerf/image/image.h"

namespace nerf {

// The gain for each channel that takes a rendering closest to a photograph, by least squares over
// the pixels that are neither black nor white to the end of their scale; 1 where there is none.
// Photographs that training never saw are compared so where exposures differ: theirs is known to
// nobody else. Three numbers for a whole photograph.
//   rendered, photograph  [R,3]
//   through  [R,3] what is seen through the scene, which has no exposure (SeenThrough); or empty
std::array<float, 3> FitGains(std::span<const float> rendered, std::span<const float> photograph,
                              std::span<const float> through, ColorEncoding encoding);

// Multiplies each pixel, [R,3], by the gains, but for what is seen through the scene.
void ApplyGains(const std::array<float, 3>& gains, std::span<const float> through,
                std::span<float> rgb);

// The part of pixels, [R,3], that is not of the scene: (1 - opacity) background.
//   opacity  [R]    background  [R,3], or [3] for all
std::vector<float> SeenThrough(std::span<const float> opacity, std::span<const float> background);

}  // namespace nerf
