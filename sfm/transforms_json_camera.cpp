#include "sfm/transforms_json_camera.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/scene/camera_intrinsics.h"
#include "nerf/scene/camera_models.h"

namespace nerf::sfm {
namespace {

// The keys of a frame, which override those of the whole file.
class FrameKeys {
 public:
  FrameKeys(const JsonFields& frame, const JsonFields& file) : levels_{&frame, &file} {}

  // The fields of the frame where they have the key, else those of the file.
  const JsonFields& Holding(std::string_view key) const {
    return levels_[0]->Has(key) ? *levels_[0] : *levels_[1];
  }
  std::optional<double> Number(std::string_view key) const { return Holding(key).Number(key); }
  double NumberOr(std::string_view key, double otherwise) const {
    return Number(key).value_or(otherwise);
  }
  const std::array<const JsonFields*, 2>& levels() const { return levels_; }

 private:
  std::array<const JsonFields*, 2> levels_;
};

void ReadSize(const FrameKeys& keys, const ImageSize& stored, Camera* camera) {
  const auto width = keys.Number("w");
  const auto height = keys.Number("h");
  if (width.has_value() != height.has_value()) {
    const char* absent = width ? "h" : "w";
    throw InputError("{} is missing; give both w and h, or neither",
                     keys.Holding(absent).Where(absent));
  }
  camera->width = stored.width;
  camera->height = stored.height;
  if (!width) return;
  for (const auto& [key, value] : {std::pair{"w", *width}, std::pair{"h", *height}}) {
    if (!(value >= 1 && value <= 1 << 20 && value == std::floor(value))) {
      throw InputError("{} must be a whole number of pixels of at least 1, not {}",
                       keys.Holding(key).Where(key), value);
    }
  }
  camera->width = static_cast<int>(*width);
  camera->height = static_cast<int>(*height);
}

std::optional<double> FocalFromAngle(const JsonFields& fields, const std::string& key,
                                     double radians_per_unit, int size) {
  const auto value = fields.Number(key);
  if (!value) return std::nullopt;
  const double angle = *value * radians_per_unit;
  if (!(angle > 0 && angle < std::numbers::pi)) {
    throw InputError("{} must lie between 0 and 180 degrees, not {:.4g}", fields.Where(key),
                     angle * 180 / std::numbers::pi);
  }
  return 0.5 * size / std::tan(0.5 * angle);
}

std::optional<double> FocalAlong(const JsonFields& fields, const std::string& axis, int size) {
  const std::string key = "fl_" + axis;
  if (const auto focal = fields.Number(key)) {
    if (*focal > 0) return focal;
    throw InputError("{} must be positive, not {}", fields.Where(key), *focal);
  }
  if (const auto focal = FocalFromAngle(fields, axis + "_fov", std::numbers::pi / 180, size)) {
    return focal;
  }
  return FocalFromAngle(fields, "camera_angle_" + axis, 1, size);
}

// One focal length of a frame stands for both; it is not combined with those of the file.
Eigen::Vector2d ReadFocalLengths(const FrameKeys& keys, const Camera& camera) {
  for (const JsonFields* fields : keys.levels()) {
    const auto x = FocalAlong(*fields, "x", camera.width);
    const auto y = FocalAlong(*fields, "y", camera.height);
    if (x || y) return {x ? *x : *y, y ? *y : *x};
  }
  throw InputError("{} is missing; give fl_x and fl_y in pixels, or camera_angle_x in radians",
                   keys.levels()[0]->Where("fl_x"));
}

// Whether the lens is a fisheye. Throws for lens models that these keys cannot describe.
bool ReadIsFisheye(const FrameKeys& keys) {
  for (const char* key : {"equirectangular", "latlong", "ftheta_p0"}) {
    const JsonFields& fields = keys.Holding(key);
    if (fields.Has(key) && (key == std::string_view("ftheta_p0") || *fields.Bool(key))) {
      throw InputError(
          "{}: this kind of lens is not supported; undistort the photographs, or cut panoramas "
          "into "
          "perspective views",
          fields.Where(key));
    }
  }
  const bool is_fisheye = keys.Holding("is_fisheye").Bool("is_fisheye").value_or(false);
  const JsonFields& fields = keys.Holding("camera_model");
  const auto name = fields.String("camera_model");
  if (!name) return is_fisheye;
  const auto model = CameraModelFromName(*name);
  if (!model) {
    throw InputError("{}: {}", fields.Where("camera_model"), UnsupportedLens(*name));
  }
  switch (*model) {
    case CameraModel::kFov:
    case CameraModel::kThinPrismFisheye:
      throw InputError("{}: the model {} needs its parameters in \"camera_params\"",
                       fields.Where("camera_model"), *name);
    case CameraModel::kOpenCVFisheye:
    case CameraModel::kSimpleRadialFisheye:
    case CameraModel::kRadialFisheye:
      return true;
    default:
      return is_fisheye;
  }
}

void ReadColmapParams(const FrameKeys& keys, Camera* camera) {
  const JsonFields& fields = keys.Holding("camera_params");
  const std::string where = fields.Where("camera_params");
  const auto name = keys.Holding("camera_model").String("camera_model");
  const auto model = name ? CameraModelFromName(*name) : std::nullopt;
  if (!model) throw InputError("{} needs \"camera_model\", one of COLMAP's names", where);
  camera->model = *model;
  for (const nlohmann::json& value : *fields.Array("camera_params")) {
    if (!value.is_number()) throw InputError("{} must be a list of finite numbers", where);
    camera->params.push_back(value.get<double>());
  }
  CheckCamera(*camera, where);
}

bool AllZero(std::initializer_list<double> values) {
  for (const double value : values) {
    if (value != 0) return false;
  }
  return true;
}

}  // namespace

Camera CameraFromJson(const JsonFields& frame, const JsonFields& file, const ImageSize& stored) {
  const FrameKeys keys(frame, file);
  Camera camera;
  ReadSize(keys, stored, &camera);
  if (keys.Holding("camera_params").Has("camera_params")) {
    ReadColmapParams(keys, &camera);
    return camera;
  }
  const bool is_fisheye = ReadIsFisheye(keys);
  const Eigen::Vector2d focal = ReadFocalLengths(keys, camera);
  camera.params = {focal.x(), focal.y(), keys.NumberOr("cx", 0.5 * camera.width),
                   keys.NumberOr("cy", 0.5 * camera.height)};
  const double k1 = keys.NumberOr("k1", 0), k2 = keys.NumberOr("k2", 0);
  const double k3 = keys.NumberOr("k3", 0), k4 = keys.NumberOr("k4", 0);
  const double k5 = keys.NumberOr("k5", 0), k6 = keys.NumberOr("k6", 0);
  const double p1 = keys.NumberOr("p1", 0), p2 = keys.NumberOr("p2", 0);
  if (is_fisheye) {
    camera.model = CameraModel::kOpenCVFisheye;
    camera.params.insert(camera.params.end(), {k1, k2, k3, k4});
  } else if (!AllZero({k3, k4, k5, k6})) {
    camera.model = CameraModel::kFullOpenCV;
    camera.params.insert(camera.params.end(), {k1, k2, p1, p2, k3, k4, k5, k6});
  } else if (!AllZero({k1, k2, p1, p2})) {
    camera.model = CameraModel::kOpenCV;
    camera.params.insert(camera.params.end(), {k1, k2, p1, p2});
  } else {
    camera.model = CameraModel::kPinhole;
  }
  CheckCamera(camera, frame.Where("camera"));
  return camera;
}

nlohmann::json JsonFromCamera(const Camera& camera) {
  nlohmann::json keys = {{"w", camera.width}, {"h", camera.height}};
  const auto lens = [&](const char* name, std::initializer_list<const char*> distortion) {
    const Eigen::Vector2d focal = FocalLengths(camera);
    const Eigen::Vector2d centre = PrincipalPoint(camera);
    keys.update({{"camera_model", name},
                 {"fl_x", focal.x()},
                 {"fl_y", focal.y()},
                 {"cx", centre.x()},
                 {"cy", centre.y()}});
    const auto first = static_cast<std::size_t>(FirstDistortionParam(camera.model));
    std::size_t i = first;
    for (const char* key : distortion) {
      keys[key] = i < camera.params.size() ? camera.params[i] : 0.0;
      ++i;
    }
    return keys;
  };
  switch (camera.model) {
    case CameraModel::kSimplePinhole:
    case CameraModel::kPinhole:
      return lens("PINHOLE", {});
    case CameraModel::kSimpleRadial:
    case CameraModel::kRadial:
    case CameraModel::kOpenCV:
      return lens("OPENCV", {"k1", "k2", "p1", "p2"});
    case CameraModel::kSimpleRadialFisheye:
    case CameraModel::kRadialFisheye:
    case CameraModel::kOpenCVFisheye:
      return lens("OPENCV_FISHEYE", {"k1", "k2", "k3", "k4"});
    case CameraModel::kFullOpenCV:
      // nerfstudio passes k3 and k4 to OpenCV's rational model, and has no k5 and k6.
      if (AllZero({camera.params[10], camera.params[11]})) {
        return lens("OPENCV", {"k1", "k2", "p1", "p2", "k3", "k4"});
      }
      [[fallthrough]];
    default:
      keys["camera_model"] = CameraModelName(camera.model);
      keys["camera_params"] = camera.params;
      return keys;
  }
}

}  // namespace nerf::sfm
