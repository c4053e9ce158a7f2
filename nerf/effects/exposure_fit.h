#pragma once

#include <array>
#include <span>
#include <vector>

#include "nerf/image/image.h"

namespace nerf {

// The gain per channel that brings a rendering closest to a photograph, by least squares over the
// pixels that are not clipped; 1 where there are none. Held-out photographs are compared this way
// where exposures differ, because training does not learn theirs.
//   rendered, photograph  [R,3]
//   background  [R,3] part of each pixel to which no exposure applies (BackgroundContribution), or
//               empty
std::array<float, 3> FitGains(std::span<const float> rendered, std::span<const float> photograph,
                              std::span<const float> background, ColorEncoding encoding);

// Multiplies each pixel, [R,3], except its background contribution, by the gains.
void ApplyGains(const std::array<float, 3>& gains, std::span<const float> background,
                std::span<float> rgb);

// The part of each pixel, [R,3], that comes from the background: (1 - opacity) * background.
//   opacity  [R]    background  [R,3], or [3] for all
std::vector<float> BackgroundContribution(std::span<const float> opacity,
                                          std::span<const float> background);

// Brings a rendering to the exposure of its photograph, which is unknown if it was held out: the
// gains of FitGains, except for the background's contribution.
//   rgb, photograph  [R,3]    opacity  [R]    background  [R,3], or [3] for all
void FitExposure(std::span<float> rgb, std::span<const float> opacity,
                 std::span<const float> photograph, std::span<const float> background,
                 ColorEncoding encoding);

}  // namespace nerf
