#pragma once

#include <cstdint>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf {

// The pixels that the lens covers, y * width + x, ascending: those outside the circle of a fisheye,
// or where a distortion cannot be inverted, see nothing. Empty: all are covered.
std::vector<std::uint32_t> PixelsInLens(const Camera& camera);

}  // namespace nerf
