#include "sfm/colmap_text_writer.h"

#include <spdlog/fmt/fmt.h>

#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/scene/camera_models.h"

namespace nerf::sfm {
namespace {

std::string CamerasText(const PosedImages& posed) {
  std::string text = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  for (std::size_t i = 0; i < posed.cameras.size(); ++i) {
    const Camera& camera = posed.cameras[i];
    text += fmt::format("{} {} {} {}", i + 1, CameraModelName(camera.model), camera.width,
                        camera.height);
    for (const double p : camera.params) text += fmt::format(" {}", p);
    text += '\n';
  }
  return text;
}

struct Observation {
  Eigen::Vector2d pixel;
  std::size_t point = 0;
};
// The observations of each image, in the order of the points.
std::vector<std::vector<Observation>> ObservationsOf(const PosedImages& posed) {
  std::vector<std::vector<Observation>> observations(posed.images.size());
  for (std::size_t p = 0; p < posed.points.size(); ++p) {
    for (const TrackElement& seen : posed.points[p].track) {
      observations[seen.image].push_back({seen.pixel, p});
    }
  }
  return observations;
}

std::string ImagesText(const PosedImages& posed,
                       const std::vector<std::vector<Observation>>& observations) {
  std::string text =
      "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; POINTS2D[] as (X, Y, POINT3D_ID)\n";
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    const PosedImage& image = posed.images[i];
    const Eigen::Isometry3d camera_from_world = image.world_from_camera.inverse();
    const Eigen::Quaterniond q(camera_from_world.linear());
    const Eigen::Vector3d t = camera_from_world.translation();
    text += fmt::format("{} {} {} {} {} {} {} {} {} {}\n", i + 1, q.w(), q.x(), q.y(), q.z(), t.x(),
                        t.y(), t.z(), image.camera + 1, image.name);
    for (const Observation& seen : observations[i]) {
      text += fmt::format("{} {} {} ", seen.pixel.x(), seen.pixel.y(), seen.point + 1);
    }
    text += '\n';
  }
  return text;
}

std::string PointsText(const PosedImages& posed) {
  std::string text = "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";
  std::vector<std::size_t> next(posed.images.size(), 0);  // observation of each image
  for (std::size_t p = 0; p < posed.points.size(); ++p) {
    const SparsePoint& point = posed.points[p];
    text += fmt::format("{} {} {} {} {} {} {} {}", p + 1, point.x_in_world.x(),
                        point.x_in_world.y(), point.x_in_world.z(), point.rgb[0], point.rgb[1],
                        point.rgb[2], point.reprojection_error);
    for (const TrackElement& seen : point.track) {
      text += fmt::format(" {} {}", seen.image + 1, next[seen.image]++);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

void WriteColmapText(const PosedImages& posed, const std::filesystem::path& folder) {
  WriteFileAtomically(folder / "cameras.txt", CamerasText(posed));
  WriteFileAtomically(folder / "images.txt", ImagesText(posed, ObservationsOf(posed)));
  WriteFileAtomically(folder / "points3D.txt", PointsText(posed));
}

}  // namespace nerf::sfm
