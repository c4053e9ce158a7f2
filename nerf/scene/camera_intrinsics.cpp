#include "nerf/scene/camera_intrinsics.h"

#include <cmath>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/scene/camera_models.h"

namespace nerf {
namespace {

bool HasOneFocalLength(CameraModel model) {
  switch (model) {
    case CameraModel::kSimplePinhole:
    case CameraModel::kSimpleRadial:
    case CameraModel::kRadial:
    case CameraModel::kSimpleRadialFisheye:
    case CameraModel::kRadialFisheye:
      return true;
    default:
      return false;
  }
}

Camera ScaledTo(Camera camera, const ImageSize& image) {
  const double scale_x = static_cast<double>(image.width) / camera.width;
  const double scale_y = static_cast<double>(image.height) / camera.height;
  camera.width = image.width;
  camera.height = image.height;
  if (HasOneFocalLength(camera.model)) {
    camera.params[0] *= std::sqrt(scale_x * scale_y);
    camera.params[1] *= scale_x;
    camera.params[2] *= scale_y;
  } else {
    camera.params[0] *= scale_x;
    camera.params[1] *= scale_y;
    camera.params[2] *= scale_x;
    camera.params[3] *= scale_y;
  }
  return camera;
}

}  // namespace

int FirstDistortionParam(CameraModel model) { return HasOneFocalLength(model) ? 3 : 4; }

Eigen::Vector2d FocalLengths(const Camera& camera) {
  if (HasOneFocalLength(camera.model)) return {camera.params[0], camera.params[0]};
  return {camera.params[0], camera.params[1]};
}

Eigen::Vector2d PrincipalPoint(const Camera& camera) {
  const int first = FirstDistortionParam(camera.model) - 2;
  return {camera.params[first], camera.params[first + 1]};
}

void CheckCamera(const Camera& camera, std::string_view where) {
  constexpr int kLargest = 1 << 20;
  if (camera.width < 1 || camera.height < 1 || camera.width > kLargest ||
      camera.height > kLargest) {
    throw InputError("{}: the image size {}x{} is not between 1 and {} pixels", where, camera.width,
                     camera.height, kLargest);
  }
  const int expected = CameraModelNumParams(camera.model);
  if (static_cast<int>(camera.params.size()) != expected) {
    throw InputError("{}: model {} has {} parameters, not {}", where, CameraModelName(camera.model),
                     expected, camera.params.size());
  }
  for (const double param : camera.params) {
    if (!std::isfinite(param)) throw InputError("{}: a parameter is not finite", where);
  }
  const Eigen::Vector2d focal = FocalLengths(camera);
  if (!(focal.minCoeff() > 0)) {
    throw InputError("{}: the focal length {} is not positive", where, focal.minCoeff());
  }
}

std::optional<bool> UprightByExif(const Camera& camera, const ImageSize& stored) {
  if (camera.width == stored.width && camera.height == stored.height) return false;
  const ImageSize upright = Upright(stored);
  if (camera.width == upright.width && camera.height == upright.height) return true;
  return std::nullopt;
}

std::optional<FittedCamera> FitToImage(const Camera& camera, const ImageSize& stored) {
  if (const auto upright = UprightByExif(camera, stored)) return FittedCamera{camera, *upright};
  const ImageSize size = {camera.width, camera.height};
  if (IsScaledCopy(size, stored)) return FittedCamera{ScaledTo(camera, stored), false};
  const ImageSize upright = Upright(stored);
  if (IsScaledCopy(size, upright)) return FittedCamera{ScaledTo(camera, upright), true};
  return std::nullopt;
}

}  // namespace nerf
