#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "nerf/image/image_files.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// (fx, fy) and (cx, cy) in pixels, for any model; a model with one focal length has fx = fy.
Eigen::Vector2d FocalLengths(const Camera& camera);
Eigen::Vector2d PrincipalPoint(const Camera& camera);
// Index of the first parameter after the principal point.
int FirstDistortionParam(CameraModel model);

// Throws InputError, beginning with `where`, unless width and height are in [1, 2^20], the number
// of parameters is that of the model, all are finite, and the focal lengths are positive.
void CheckCamera(const Camera& camera, std::string_view where);

// Whether a camera describes the pixels as stored in the file (false) or after rotation by the EXIF
// orientation (true), from its width and height. Where both fit, as stored, since COLMAP ignores
// EXIF.
//   returns  nullopt where neither fits
std::optional<bool> UprightByExif(const Camera& camera, const ImageSize& stored);

// A camera in the pixels of an image file.
struct FittedCamera {
  Camera camera;
  bool upright_by_exif = false;
};

// The same, but the image may also be a scaled copy of the camera's (IsScaledCopy). Scales the
// intrinsics to the image.
//   returns  nullopt where nothing fits
std::optional<FittedCamera> FitToImage(const Camera& camera, const ImageSize& stored);

}  // namespace nerf
