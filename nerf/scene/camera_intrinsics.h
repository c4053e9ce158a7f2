#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "nerf/image/image_files.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// fx, fy and cx, cy in pixels, whatever the model; a model with one focal length gives it twice.
Eigen::Vector2d FocalLengths(const Camera& camera);
Eigen::Vector2d PrincipalPoint(const Camera& camera);
// The first parameter after the principal point.
int FirstDistortionParam(CameraModel model);

// Throws InputError that begins with `where` unless width and height are at least 1, the number of
// parameters is the model's, all are finite and the focal lengths positive.
void CheckCamera(const Camera& camera, std::string_view where);

// Whether a camera of width x height describes the pixels as they are stored (false) or after they
// were turned upright as EXIF says (true); nullopt where it fits neither way. COLMAP ignores EXIF,
// so the stored size decides wherever both fit.
std::optional<bool> UprightByExif(const Camera& camera, const ImageSize& stored);

// A camera in the pixels of an image file.
struct FittedCamera {
  Camera camera;
  bool upright_by_exif = false;
};

// As above, but the image may also be a larger or smaller copy of the camera's: with exactly the
// same proportions, or reduced by a whole factor with the remainder cut or rounded (1079 -> 539).
// The intrinsics are scaled to the image. nullopt where it fits neither way.
std::optional<FittedCamera> FitToImage(const Camera& camera, const ImageSize& stored);

}  // namespace nerf
