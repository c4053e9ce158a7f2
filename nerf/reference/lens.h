#pragma once

#include <array>

#include "nerf/scene/posed_images.h"

namespace nerf::reference {

// The projection of a point in front of the camera: each model of COLMAP 3.8 written out
// separately, after the comments of its src/base/camera_models.h.
std::array<double, 2> PixelFromPoint(const Camera& camera, const std::array<double, 3>& x);

}  // namespace nerf::reference
