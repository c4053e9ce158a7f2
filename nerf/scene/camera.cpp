#include "nerf/scene/camera.h"

#include <cassert>
#include <cmath>

#include "nerf/scene/camera_models.h"

namespace nerf {
namespace {

std::optional<Eigen::Vector2d> IdealFromDirection(bool is_fisheye, const Eigen::Vector3d& x) {
  if (!is_fisheye)
    return x.z() > 0 ? std::optional<Eigen::Vector2d>(x.head<2>() / x.z()) : std::nullopt;
  const double radius = x.head<2>().norm();
  if (radius == 0) return x.z() > 0 ? std::optional(Eigen::Vector2d(0, 0)) : std::nullopt;
  return x.head<2>() * (std::atan2(radius, x.z()) / radius);
}

Eigen::Vector3d DirectionFromIdeal(bool is_fisheye, const Eigen::Vector2d& ideal) {
  if (!is_fisheye) return ideal.homogeneous().normalized();
  const double theta = ideal.norm();
  if (theta == 0) return Eigen::Vector3d::UnitZ();
  const Eigen::Vector2d lateral = ideal * (std::sin(theta) / theta);
  return {lateral.x(), lateral.y(), std::cos(theta)};
}

}  // namespace

LensDistortion LensOf(const Camera& camera) {
  assert(static_cast<int>(camera.params.size()) == CameraModelNumParams(camera.model));
  const double* d = camera.params.data() + FirstDistortionParam(camera.model);
  LensDistortion lens;
  switch (camera.model) {
    case CameraModel::kSimplePinhole:
    case CameraModel::kPinhole:
      break;
    case CameraModel::kSimpleRadialFisheye:
      lens.is_fisheye = true;
      [[fallthrough]];
    case CameraModel::kSimpleRadial:
      lens.numerator = {1, d[0], 0, 0, 0};
      break;
    case CameraModel::kRadialFisheye:
      lens.is_fisheye = true;
      [[fallthrough]];
    case CameraModel::kRadial:
      lens.numerator = {1, d[0], d[1], 0, 0};
      break;
    case CameraModel::kOpenCV:
      lens.numerator = {1, d[0], d[1], 0, 0};
      lens.tangential = {d[2], d[3]};
      break;
    case CameraModel::kOpenCVFisheye:
      lens.is_fisheye = true;
      lens.numerator = {1, d[0], d[1], d[2], d[3]};
      break;
    case CameraModel::kFullOpenCV:
      lens.numerator = {1, d[0], d[1], d[4], 0};
      lens.denominator = {1, d[5], d[6], d[7]};
      lens.tangential = {d[2], d[3]};
      break;
    case CameraModel::kFov:
      lens.fov_omega = d[0];
      break;
    case CameraModel::kThinPrismFisheye:
      lens.is_fisheye = true;
      lens.numerator = {1, d[0], d[1], d[4], d[5]};
      lens.tangential = {d[2], d[3]};
      lens.prism = {d[6], d[7]};
      break;
  }
  return lens;
}

std::optional<Eigen::Vector3d> DirectionFromPixel(const Camera& camera,
                                                  const Eigen::Vector2d& pixel) {
  const LensDistortion lens = LensOf(camera);
  const Eigen::Vector2d distorted =
      (pixel - PrincipalPoint(camera)).cwiseQuotient(FocalLengths(camera));
  const auto ideal = IdealFromDistorted(lens, distorted);
  if (!ideal) return std::nullopt;
  return DirectionFromIdeal(lens.is_fisheye, *ideal);
}

std::optional<Eigen::Vector2d> PixelFromPoint(const Camera& camera,
                                              const Eigen::Vector3d& x_in_camera) {
  const LensDistortion lens = LensOf(camera);
  const auto ideal = IdealFromDirection(lens.is_fisheye, x_in_camera);
  if (!ideal) return std::nullopt;
  const auto distorted = DistortedFromIdeal(lens, *ideal);
  if (!distorted) return std::nullopt;
  return distorted->cwiseProduct(FocalLengths(camera)) + PrincipalPoint(camera);
}

Camera Downscaled(const Camera& camera, int factor) {
  Camera result = camera;
  result.width /= factor;
  result.height /= factor;
  const int num_in_pixels = FirstDistortionParam(camera.model);
  for (int i = 0; i < num_in_pixels; ++i) result.params[i] /= factor;
  return result;
}

Camera CropRows(const Camera& camera, int top, int height) {
  Camera result = camera;
  result.height = height;
  result.params[FirstDistortionParam(camera.model) - 1] -= top;  // y of the principal point
  return result;
}

Camera CropColumns(const Camera& camera, int left, int width) {
  Camera result = camera;
  result.width = width;
  result.params[FirstDistortionParam(camera.model) - 2] -= left;  // x of the principal point
  return result;
}

std::int64_t PixelCount(const Camera& camera) {
  return static_cast<std::int64_t>(camera.width) * camera.height;
}

double FocalLength(const Camera& camera) { return FocalLengths(camera).mean(); }

Camera PinholeFromFov(int width, int height, double vertical_fov) {
  const double focal = height / (2 * std::tan(vertical_fov / 2));
  return {.model = CameraModel::kPinhole,
          .width = width,
          .height = height,
          .params = {focal, focal, width / 2.0, height / 2.0}};
}

}  // namespace nerf
