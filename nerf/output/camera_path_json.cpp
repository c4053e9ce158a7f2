#include "nerf/output/camera_path_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <string_view>

#include "nerf/base/input_error.h"
#include "nerf/base/json_fields.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/rigid_pose.h"
#include "sfm/transforms_json_camera.h"

namespace nerf {
namespace {

using nlohmann::json;

constexpr int kMaxSide = 1 << 16;  // pixels

Eigen::Isometry3d WorldFromCamera(const JsonFields& fields, std::string_view key) {
  const std::string where = fields.Where(key);
  const json* value = fields.Array(key);
  if (!value) throw InputError("{} is missing; give 16 numbers, row by row", where);
  return WorldFromOpenCVCamera(
      RigidFromScaledMatrix(PoseMatrixFromJson(*value, where), where).pose);
}

double VerticalFov(const JsonFields& fields, std::string_view key) {
  const auto degrees = fields.Number(key);
  if (!degrees)
    throw InputError("{} is missing; give the vertical angle in degrees", fields.Where(key));
  if (!(*degrees > 0 && *degrees < 180)) {
    throw InputError("{}: {} degrees, give an angle between 0 and 180", fields.Where(key),
                     *degrees);
  }
  return *degrees * std::numbers::pi / 180;
}

std::optional<int> Pixels(const JsonFields& fields, std::string_view key) {
  const auto number = fields.Number(key);
  if (!number) return std::nullopt;
  if (!(*number >= 1 && *number <= kMaxSide && *number == std::floor(*number))) {
    throw InputError("{}: {} pixels, give a whole number from 1 to {}", fields.Where(key), *number,
                     kMaxSide);
  }
  return static_cast<int>(*number);
}

struct Size {
  int width;
  int height;
};

Size PictureSize(const JsonFields& file, std::optional<int> width, std::optional<int> height) {
  if (width && height) return {*width, *height};
  const auto file_width = Pixels(file, "render_width");
  const auto file_height = Pixels(file, "render_height");
  for (const auto& [key, value] :
       {std::pair{"render_width", file_width}, std::pair{"render_height", file_height}}) {
    if (!value) throw InputError("{} is missing; give the size in pixels", file.Where(key));
  }
  const double aspect = static_cast<double>(*file_width) / *file_height;
  if (width) return {*width, std::max(1, static_cast<int>(std::lround(*width / aspect)))};
  if (height) return {std::max(1, static_cast<int>(std::lround(*height * aspect))), *height};
  return {*file_width, *file_height};
}

double FramesPerSecond(const JsonFields& file, std::size_t num_frames) {
  for (const std::string_view key : {"fps", "seconds"}) {
    const auto value = file.Number(key);
    if (!value) continue;
    if (!(*value > 0)) throw InputError("{}: {}, give more than 0", file.Where(key), *value);
    return key == "fps" ? *value : static_cast<double>(num_frames) / *value;
  }
  return CameraPath().frames_per_second;
}

bool HasLensKey(const JsonFields& pose) {
  for (const char* key :
       {"fl_x", "fl_y", "x_fov", "y_fov", "camera_angle_x", "camera_angle_y", "camera_params"}) {
    if (pose.Has(key)) return true;
  }
  return false;
}

}  // namespace

CameraPath ReadCameraPath(const std::filesystem::path& json_path, std::optional<int> width,
                          std::optional<int> height) {
  const json root = ReadJsonFile(json_path);
  const JsonFields file(root, json_path.string() + ": ");
  const auto kind = file.String("camera_type");
  if (kind && *kind != "perspective") {
    throw InputError("{}: '{}' is not supported, give \"perspective\"", file.Where("camera_type"),
                     *kind);
  }
  const json* frames = file.Array("camera_path");
  if (!frames || frames->empty()) {
    throw InputError("{} is missing or empty; give a list of cameras", file.Where("camera_path"));
  }
  const Size size = PictureSize(file, width, height);
  CameraPath path;
  path.frames_per_second = FramesPerSecond(file, frames->size());
  for (std::size_t i = 0; i < frames->size(); ++i) {
    const JsonFields frame((*frames)[i], fmt::format("{}[{}].", file.Where("camera_path"), i));
    path.poses.push_back(
        {.world_from_camera = WorldFromCamera(frame, "camera_to_world"),
         .camera = PinholeFromFov(size.width, size.height, VerticalFov(frame, "fov")),
         .seconds = static_cast<double>(i) / path.frames_per_second});
  }
  return path;
}

PathPose ReadPose(const std::filesystem::path& json_path, const PosedImages& images) {
  const json root = ReadJsonFile(json_path);
  const JsonFields pose(root, json_path.string() + ": ");
  if (images.images.empty()) {
    throw InputError("{}: contains no camera", images.source.string());
  }
  const Camera& first = images.cameras[images.images.front().camera];
  PathPose result{.world_from_camera = WorldFromCamera(
                      pose, pose.Has("camera_to_world") ? "camera_to_world" : "transform_matrix"),
                  .camera = first};
  if (pose.Has("fov")) {
    result.camera =
        PinholeFromFov(Pixels(pose, "w").value_or(first.width),
                       Pixels(pose, "h").value_or(first.height), VerticalFov(pose, "fov"));
  } else if (HasLensKey(pose)) {
    result.camera = sfm::CameraFromJson(pose, pose, {.width = first.width, .height = first.height});
  }
  return result;
}

}  // namespace nerf
