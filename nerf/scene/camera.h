#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "nerf/scene/camera_intrinsics.h"
#include "nerf/scene/lens_distortion.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Pixel <-> direction for every camera model of COLMAP 3.8, in camera axes (OpenCV: x right, y
// down, z forward). Pixel centres lie at +0.5. Formulae: COLMAP src/base/camera_models.h.

// The distortion of a camera's lens, without focal lengths and principal point.
LensDistortion LensOf(const Camera& camera);

// Unit direction through a pixel. Inverts the lens distortion by Newton's method in double.
//   returns  nullopt where the inverse does not converge or the pixel is outside the valid range of
//            the lens model (for example outside the image circle of a fisheye)
std::optional<Eigen::Vector3d> DirectionFromPixel(const Camera& camera,
                                                  const Eigen::Vector2d& pixel);

// Projects a point into the image. Perspective models do not project points with z <= 0 (so nothing
// is mirrored from behind the camera); fisheye models project what their formula allows.
//   returns  nullopt where the point has no projection
std::optional<Eigen::Vector2d> PixelFromPoint(const Camera& camera,
                                              const Eigen::Vector3d& x_in_camera);

// The camera of an image reduced by Downscale(image, factor), which averages whole blocks only: the
// width is floor(width / factor), and focal lengths and principal point are divided by factor.
Camera Downscaled(const Camera& camera, int factor);

// The camera of a crop: `height` full rows from row `top` on, or `width` full columns from column
// `left` on.
Camera CropRows(const Camera& camera, int top, int height);
Camera CropColumns(const Camera& camera, int left, int width);

// Number of pixels of the image.
std::int64_t PixelCount(const Camera& camera);

// Mean focal length in pixels.
double FocalLength(const Camera& camera);

// A camera without lens distortion, its principal point in the centre of the image.
//   vertical_fov  full angle in radians
Camera PinholeFromFov(int width, int height, double vertical_fov);

}  // namespace nerf
