#pragma once

#include <Eigen/Core>
#include <optional>

#include "nerf/scene/camera_intrinsics.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Pixel <-> direction for every camera model of COLMAP 3.8, in camera axes (OpenCV: x right, y
// down, z forward). Pixel centres lie at +0.5. Formulae: COLMAP src/base/camera_models.h.

// Unit direction through a pixel. Inverts the lens distortion by Newton's method in double.
//   returns  nullopt where the inverse does not converge or the pixel lies beyond the lens' reach
//            (for example outside the image circle of a fisheye)
std::optional<Eigen::Vector3d> DirectionFromPixel(const Camera& camera,
                                                  const Eigen::Vector2d& pixel);

// Pixel that sees a point. For perspective models, points with z <= 0 have none (never mirrored);
// fisheye models see what their formula allows.
std::optional<Eigen::Vector2d> PixelFromPoint(const Camera& camera,
                                              const Eigen::Vector3d& x_in_camera);

// The camera of an image that Downscale(image, factor) made: whole blocks only, so the width is
// floor(width / factor) and focal lengths and principal point are divided by factor.
Camera Downscaled(const Camera& camera, int factor);

// The camera of a part of the image: `height` whole rows from row `top` on.
Camera RowsOf(const Camera& camera, int top, int height);
// The same of whole columns, from column `left` on.
Camera ColumnsOf(const Camera& camera, int left, int width);

// Mean focal length in pixels.
double FocalLength(const Camera& camera);

// A distortion-free camera.
//   vertical_fov  full angle in radians
Camera PinholeFromFov(int width, int height, double vertical_fov);

}  // namespace nerf
