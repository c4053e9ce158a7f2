#include "nerf/transport/surface_scene.h"

#include <algorithm>
#include <limits>

namespace nerf {
namespace {

// Rays that leave a surface start this far along their way, so that rounding does not make them
// meet the surface they left; scene units.
constexpr double kSkip = 1e-6;

}  // namespace

std::optional<SurfaceHit> FirstHit(const SurfaceScene& scene, const Ray& ray) {
  Intersection nearest{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero()};
  const Surface* met = nullptr;
  for (const Surface& surface : scene.surfaces) {
    const auto crossing = Intersect(surface.shape, ray, kSkip);
    if (crossing && crossing->distance < nearest.distance) nearest = *crossing, met = &surface;
  }
  if (met == nullptr) return std::nullopt;
  const bool from_outside = nearest.normal_in_world.dot(ray.direction_in_world) <= 0;
  const Eigen::Vector3d normal =
      from_outside ? nearest.normal_in_world : Eigen::Vector3d(-nearest.normal_in_world);
  return SurfaceHit{ray.origin_in_world + nearest.distance * ray.direction_in_world, normal, met};
}

bool IsBlocked(const SurfaceScene& scene, const Ray& ray, double distance) {
  return std::ranges::any_of(scene.surfaces, [&](const Surface& surface) {
    const auto crossing = Intersect(surface.shape, ray, kSkip);
    return crossing && crossing->distance < distance - kSkip;
  });
}

}  // namespace nerf
