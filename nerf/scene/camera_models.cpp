#include "nerf/scene/camera_models.h"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <charconv>
#include <iterator>
#include <string>

namespace nerf {
namespace {

struct Entry {
  std::string_view name;
  int num_params;
};

// By COLMAP's numeric id.
constexpr std::array<Entry, kNumCameraModels> kModels = {{
    {"SIMPLE_PINHOLE", 3},
    {"PINHOLE", 4},
    {"SIMPLE_RADIAL", 4},
    {"RADIAL", 5},
    {"OPENCV", 8},
    {"OPENCV_FISHEYE", 8},
    {"FULL_OPENCV", 12},
    {"FOV", 5},
    {"SIMPLE_RADIAL_FISHEYE", 4},
    {"RADIAL_FISHEYE", 5},
    {"THIN_PRISM_FISHEYE", 12},
}};

}  // namespace

std::string_view CameraModelName(CameraModel model) {
  return kModels[static_cast<int>(model)].name;
}

int CameraModelNumParams(CameraModel model) { return kModels[static_cast<int>(model)].num_params; }

std::optional<CameraModel> CameraModelFromId(int id) {
  if (id < 0 || id >= kNumCameraModels) return std::nullopt;
  return static_cast<CameraModel>(id);
}

std::optional<CameraModel> CameraModelFromName(std::string_view name) {
  for (int id = 0; id < kNumCameraModels; ++id) {
    if (kModels[id].name == name) return static_cast<CameraModel>(id);
  }
  return std::nullopt;
}

std::string UnsupportedLens(std::string_view name) {
  // Names of models that exist elsewhere, by COLMAP's numeric ids from 11 on.
  static constexpr std::array<std::string_view, 7> kNewer = {"RAD_TAN_THIN_PRISM_FISHEYE",
                                                             "SIMPLE_DIVISION",
                                                             "DIVISION",
                                                             "SIMPLE_FISHEYE",
                                                             "FISHEYE",
                                                             "EUCM",
                                                             "EQUIRECTANGULAR"};
  std::string shown(name);
  int id = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), id);
  if (error == std::errc() && id >= kNumCameraModels &&
      id < kNumCameraModels + std::ssize(kNewer)) {
    shown = fmt::format("{} (id {})", kNewer[id - kNumCameraModels], id);
  }
  for (const std::string_view panorama : {"EQUIRECTANGULAR", "VR180", "OMNI"}) {
    if (shown.find(panorama) == std::string::npos) continue;
    return fmt::format(
        "the camera model {} is not supported: it shows more than a perspective view; cut the "
        "pictures into perspective views",
        shown);
  }
  return fmt::format(
      "the camera model {} is not supported; undistort the photographs with colmap "
      "image_undistorter, and give its output folder",
      shown);
}

}  // namespace nerf
