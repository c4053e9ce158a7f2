#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace nerf {

// The camera models of COLMAP 3.8, in the order of its numeric ids.
// Source: COLMAP src/base/camera_models.h (formulae), documentation "Camera Models" (names).
enum class CameraModel {
  kSimplePinhole = 0,    // f, cx, cy
  kPinhole,              // fx, fy, cx, cy
  kSimpleRadial,         // f, cx, cy, k
  kRadial,               // f, cx, cy, k1, k2
  kOpenCV,               // fx, fy, cx, cy, k1, k2, p1, p2
  kOpenCVFisheye,        // fx, fy, cx, cy, k1, k2, k3, k4
  kFullOpenCV,           // fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, k5, k6
  kFov,                  // fx, fy, cx, cy, omega
  kSimpleRadialFisheye,  // f, cx, cy, k
  kRadialFisheye,        // f, cx, cy, k1, k2
  kThinPrismFisheye,     // fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, sx1, sy1
};
inline constexpr int kNumCameraModels = 11;

// One lens and sensor. Pixel centres lie at +0.5: the corner of the image is (0, 0), its far
// corner (width, height). `params` are in pixels, in COLMAP's order for the model.
struct Camera {
  CameraModel model = CameraModel::kPinhole;
  int width = 0;
  int height = 0;
  std::vector<double> params;

  bool operator==(const Camera&) const = default;
};

// The split of an image. kUnspecified until AssignSplits where the source does not define it.
enum class Split { kUnspecified, kTrain, kValidation, kTest };

// The light on a photograph, as far as a capture names it.
struct NamedLight {
  std::string name;  // of all photographs under the same one; empty: none is given
  // Towards a single distant light in a dark room (one light at a time), unit, in the world.
  std::optional<Eigen::Vector3d> direction;
  Eigen::Array3d irradiance = Eigen::Array3d::Constant(std::numbers::pi);  // of that light

  bool operator==(const NamedLight& other) const {
    return name == other.name && direction == other.direction &&
           (irradiance == other.irradiance).all();
  }
};

// One photograph with a known pose.
struct PosedImage {
  std::string name;                 // in the source, unique, '/' between folders
  std::filesystem::path path;       // image file
  std::filesystem::path mask = {};  // mask file, black where masked out; empty: none
  int camera = 0;                   // index into PosedImages::cameras
  Eigen::Isometry3d
      world_from_camera;         // OpenCV axes: x right, y down, z forward; units of the source
  bool upright_by_exif = false;  // the camera describes the pixels after rotation by EXIF
  Split split = Split::kUnspecified;
  NamedLight light = {};
};

// The folder to which the name of an image is relative: "photos" for photos/left/1.jpg of the name
// left/1.jpg.
inline std::filesystem::path RootOf(const PosedImage& image) {
  std::filesystem::path root = image.path;
  for ([[maybe_unused]] const auto& part : std::filesystem::path(image.name)) {
    root = root.parent_path();
  }
  return root;
}

// An observation of a sparse point in an image.
struct TrackElement {
  int image = 0;  // index into PosedImages::images
  Eigen::Vector2d pixel;
};

// A point reconstructed by structure from motion.
struct SparsePoint {
  Eigen::Vector3d x_in_world;
  std::array<std::uint8_t, 3> rgb{};
  double reprojection_error = 0;  // pixels, mean over the track
  std::vector<TrackElement> track;
};

// Photographs with lenses and poses, and sparse points where there are any: the output of sfm. In
// the units and the world frame of the source.
struct PosedImages {
  std::vector<Camera> cameras;
  std::vector<PosedImage> images;
  std::vector<SparsePoint> points;  // may be empty
  std::optional<std::array<double, 2>>
      depth_range_in_world;           // near, far; where the source has them
  std::vector<std::string> missing;   // images of the source without a readable file
  std::vector<std::string> warnings;  // what else is odd about the source, one line each
  std::filesystem::path source;       // file or folder from which the poses were read
};

}  // namespace nerf
