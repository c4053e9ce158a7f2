#include "nerf/synthetic/sparse_points.h"

#include <cmath>
#include <random>

#include "nerf/scene/camera.h"
#include "nerf/synthetic/ray_tracer.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kPoints = 3000;
constexpr double kPixelError = 0.33;  // standard deviation along each axis
constexpr double kSameDepth = 0.005;  // relative difference of distances to the same point
constexpr std::size_t kMinTrack = 3;  // shortest track that COLMAP keeps

Ray RayTo(const Vector3d& from, const Vector3d& to) { return {from, (to - from).normalized()}; }

// The pixel at which a camera sees a point; nullopt if the point is hidden or out of view.
std::optional<Vector2d> VisiblePixel(const Scene& scene, const std::vector<Object>& passers_by,
                                     const Camera& camera,
                                     const Eigen::Isometry3d& world_from_camera,
                                     const Vector3d& x_in_world) {
  const auto pixel = PixelFromPoint(camera, world_from_camera.inverse() * x_in_world);
  if (!pixel || pixel->x() < 1 || pixel->y() < 1 || pixel->x() > camera.width - 1 ||
      pixel->y() > camera.height - 1) {
    return std::nullopt;
  }
  const Ray ray = RayTo(world_from_camera.translation(), x_in_world);
  const double distance = (x_in_world - ray.origin_in_world).norm();
  const auto hit = Trace(scene, ray);
  if (!hit || std::fabs(hit->distance - distance) > kSameDepth * distance) return std::nullopt;
  if (IsBlocked(passers_by, ray, distance)) return std::nullopt;
  return pixel;
}

}  // namespace

std::vector<SparsePoint> SparsePoints(const Scene& scene, const PosedImages& posed,
                                      const SampleOptions& options) {
  std::mt19937 generator(options.seed);
  std::uniform_int_distribution<std::size_t> any_image(0, posed.images.size() - 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> error(0, kPixelError);
  std::vector<std::vector<Object>> passers;
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    passers.push_back(PhotoSettingsFor(options.scenario, static_cast<int>(i), options.seed,
                                       posed.images[i].world_from_camera)
                          .passers_by);
  }
  std::vector<SparsePoint> points;
  for (int i = 0; i < kPoints; ++i) {
    const PosedImage& image = posed.images[any_image(generator)];
    const Camera& camera = posed.cameras[image.camera];
    const Vector2d pixel(uniform(generator) * camera.width, uniform(generator) * camera.height);
    const auto direction = DirectionFromPixel(camera, pixel);
    if (!direction) continue;
    const auto hit = Trace(scene, {image.world_from_camera.translation(),
                                   image.world_from_camera.linear() * *direction});
    if (!hit) continue;
    SparsePoint point;
    point.x_in_world = hit->x_in_world;
    for (std::size_t k = 0; k < posed.images.size(); ++k) {
      const PosedImage& other = posed.images[k];
      const auto seen = VisiblePixel(scene, passers[k], posed.cameras[other.camera],
                                     other.world_from_camera, point.x_in_world);
      if (!seen) continue;
      const Vector2d noise(error(generator), error(generator));
      point.track.push_back({static_cast<int>(k), *seen + noise});
      point.reprojection_error += noise.norm();
    }
    if (point.track.size() < kMinTrack) continue;
    point.reprojection_error /= static_cast<double>(point.track.size());
    points.push_back(std::move(point));
  }
  return points;
}

}  // namespace nerf::synthetic
