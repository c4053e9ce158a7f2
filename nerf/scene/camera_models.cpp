#include "nerf/scene/camera_models.h"

#include <array>

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

}  // namespace nerf
