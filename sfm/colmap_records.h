#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "nerf/scene/posed_images.h"

// The records of the files of a COLMAP model.
// Format: COLMAP documentation "Output Format"; src/base/reconstruction.cc of COLMAP 3.8.
namespace nerf::sfm::colmap {

using CameraMap = std::map<std::uint32_t, Camera>;  // by COLMAP's camera id

struct ImageRecord {
  std::uint32_t id = 0;
  Eigen::Vector4d rotation;  // quaternion w x y z, camera from world
  Eigen::Vector3d translation;
  std::uint32_t camera_id = 0;
  std::string name;
  std::vector<Eigen::Vector2d> points2d;  // pixels
};

struct PointRecord {
  std::uint64_t id = 0;
  Eigen::Vector3d x_in_world;
  std::array<std::uint8_t, 3> rgb{};
  double reprojection_error = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> track;  // image id, index into points2d
};

// Each reads one file. Counts are checked against the remaining bytes before memory is allocated.
// Throws InputError naming the file (and the line of a text file) when it is truncated, longer than
// its counts claim, has an unknown camera model, or lists an id twice.
CameraMap ReadCamerasBinary(const std::filesystem::path& file);
CameraMap ReadCamerasText(const std::filesystem::path& file);
std::vector<ImageRecord> ReadImagesBinary(const std::filesystem::path& file);
std::vector<ImageRecord> ReadImagesText(const std::filesystem::path& file);
std::vector<PointRecord> ReadPointsBinary(const std::filesystem::path& file);
std::vector<PointRecord> ReadPointsText(const std::filesystem::path& file);

// The number of images, without reading them. Throws InputError naming the file.
int CountImagesBinary(const std::filesystem::path& file);
int CountImagesText(const std::filesystem::path& file);

}  // namespace nerf::sfm::colmap
