#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
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

// Which part of the data an image belongs to, where the data set itself says so.
enum class Split { kUnspecified, kTrain, kValidation, kTest };

// One photograph with a known pose.
struct PosedImage {
  std::string name;                     // as the source calls it, unique, '/' between folders
  std::filesystem::path path;           // where the pixels are
  std::filesystem::path mask = {};      // black where they are masked out; empty: there is none
  int camera = 0;                       // index into PosedImages::cameras
  Eigen::Isometry3d world_from_camera;  // OpenCV axes: x right, y down, z forward; source's units
  bool upright_by_exif = false;  // the camera describes the pixels after turning them by EXIF
  Split split = Split::kUnspecified;
};

// One sighting of a sparse point.
struct TrackElement {
  int image = 0;  // index into PosedImages::images
  Eigen::Vector2d pixel;
};

// A point that structure from motion found.
struct SparsePoint {
  Eigen::Vector3d x_in_world;
  std::array<std::uint8_t, 3> rgb{};
  double reprojection_error = 0;  // pixels, mean over the track
  std::vector<TrackElement> track;
};

// What sfm hands to nerf: photographs, lenses, poses, and the sparse points where there are any.
// Everything is in the units and the world frame of the source.
struct PosedImages {
  std::vector<Camera> cameras;
  std::vector<PosedImage> images;
  std::vector<SparsePoint> points;                            // may be empty
  std::optional<std::array<double, 2>> depth_range_in_world;  // near, far, where the source says so
  std::vector<std::string> missing;  // named by the source, but not among the files
  std::filesystem::path source;      // the file or folder the poses were read from
};

}  // namespace nerf
