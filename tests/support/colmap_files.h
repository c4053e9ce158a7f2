#pragma once

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <string>

#include "nerf/scene/camera_models.h"
#include "sfm/colmap_records.h"

namespace nerf::test {

// The content of COLMAP's files, as written by COLMAP 3.8.
struct ColmapFiles {
  std::string cameras;
  std::string images;
  std::string points;
};

struct ColmapContents {
  sfm::colmap::CameraMap cameras;
  std::vector<sfm::colmap::ImageRecord> images;
  std::vector<sfm::colmap::PointRecord> points;
};

namespace internal {
template <class T>
void Append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}
}  // namespace internal

inline ColmapFiles BinaryColmapFiles(const ColmapContents& contents) {
  using internal::Append;
  ColmapFiles files;
  Append<std::uint64_t>(files.cameras, contents.cameras.size());
  for (const auto& [id, camera] : contents.cameras) {
    Append<std::uint32_t>(files.cameras, id);
    Append<std::int32_t>(files.cameras, static_cast<int>(camera.model));
    Append<std::uint64_t>(files.cameras, camera.width);
    Append<std::uint64_t>(files.cameras, camera.height);
    for (const double param : camera.params) Append(files.cameras, param);
  }
  Append<std::uint64_t>(files.images, contents.images.size());
  for (const auto& image : contents.images) {
    Append<std::uint32_t>(files.images, image.id);
    for (const double q : image.rotation) Append(files.images, q);
    for (const double t : image.translation) Append(files.images, t);
    Append<std::uint32_t>(files.images, image.camera_id);
    files.images += image.name + '\0';
    Append<std::uint64_t>(files.images, image.points2d.size());
    for (const Eigen::Vector2d& pixel : image.points2d) {
      Append(files.images, pixel.x());
      Append(files.images, pixel.y());
      Append<std::int64_t>(files.images, -1);
    }
  }
  Append<std::uint64_t>(files.points, contents.points.size());
  for (const auto& point : contents.points) {
    Append<std::uint64_t>(files.points, point.id);
    for (const double x : point.x_in_world) Append(files.points, x);
    for (const std::uint8_t channel : point.rgb) Append(files.points, channel);
    Append(files.points, point.reprojection_error);
    Append<std::uint64_t>(files.points, point.track.size());
    for (const auto& [image_id, point2d] : point.track) {
      Append<std::uint32_t>(files.points, image_id);
      Append<std::uint32_t>(files.points, point2d);
    }
  }
  return files;
}

inline ColmapFiles TextColmapFiles(const ColmapContents& contents) {
  ColmapFiles files;
  files.cameras = "# Camera list with one line of data per camera:\n";
  for (const auto& [id, camera] : contents.cameras) {
    files.cameras +=
        fmt::format("{} {} {} {}", id, CameraModelName(camera.model), camera.width, camera.height);
    for (const double param : camera.params) files.cameras += fmt::format(" {}", param);
    files.cameras += '\n';
  }
  files.images = "# Image list with two lines of data per image:\n#\n";
  for (const auto& image : contents.images) {
    files.images += fmt::format("{}", image.id);
    for (const double q : image.rotation) files.images += fmt::format(" {}", q);
    for (const double t : image.translation) files.images += fmt::format(" {}", t);
    files.images += fmt::format(" {} {}\n", image.camera_id, image.name);
    for (const Eigen::Vector2d& pixel : image.points2d) {
      files.images += fmt::format("{} {} -1 ", pixel.x(), pixel.y());
    }
    files.images += '\n';
  }
  files.points = "# 3D point list with one line of data per point:\n";
  for (const auto& point : contents.points) {
    files.points += fmt::format("{} {} {} {} {} {} {} {}", point.id, point.x_in_world.x(),
                                point.x_in_world.y(), point.x_in_world.z(), point.rgb[0],
                                point.rgb[1], point.rgb[2], point.reprojection_error);
    for (const auto& [image_id, point2d] : point.track) {
      files.points += fmt::format(" {} {}", image_id, point2d);
    }
    files.points += '\n';
  }
  return files;
}

// Three images out of order, two cameras, two points.
inline ColmapContents SmallColmapContents() {
  ColmapContents contents;
  contents.cameras[3] = Camera{CameraModel::kSimpleRadial, 12, 8, {10, 6, 4, 0.1}};
  contents.cameras[9] = Camera{CameraModel::kPinhole, 6, 5, {7, 8, 3, 2.5}};
  const double half = std::sqrt(0.5);
  contents.images = {
      {21, {half, 0, 0, half}, {1, 2, 3}, 3, "c.ppm", {{1.5, 2.5}, {3, 4}}},
      {5, {1, 0, 0, 0}, {0, 0, 4}, 9, "a b.ppm", {{0.25, 0.75}}},
      {8, {2, 0, 0, 0}, {0, 1, 0}, 3, "sub/b.ppm", {{7, 6}, {5, 4}, {3, 2}}},
  };
  contents.points = {
      {100, {1, 2, 3}, {10, 20, 30}, 0.5, {{21, 1}, {5, 0}, {8, 2}}},
      {7, {-1, 0.1, 1e3}, {255, 0, 1}, 1.25, {{8, 0}, {21, 0}}},
  };
  return contents;
}

}  // namespace nerf::test
