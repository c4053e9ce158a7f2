#pragma once

#include <Eigen/Geometry>

#include "nerf/kernels/gaussians.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// A camera as the kernels of Gaussians take it. The FOV model is replaced by a polynomial fitted to
// it over the picture; where that is off by half a pixel, InputError is thrown.
//   camera                  of the picture to be drawn
//   normalized_from_camera  OpenCV axes
//   near                    normalized units, > 0
kernels::GaussianCamera MakeGaussianCamera(const Camera& camera,
                                           const Eigen::Isometry3d& normalized_from_camera,
                                           double near);

}  // namespace nerf
