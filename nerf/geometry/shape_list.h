#pragma once

#include <concepts>
#include <limits>
#include <optional>
#include <vector>

#include "nerf/geometry/shapes.h"

namespace nerf {

// Closest-hit and any-hit queries over the surfaces of a scene: any structs that have a `shape`.
// They test every shape; scenes have a handful.

template <class T>
concept HasShape = requires(const T& item) {
  { item.shape } -> std::convertible_to<const Shape&>;
};

// Hits closer than this are ignored, so that rounding does not make a ray meet the surface that it
// leaves; scene units.
inline constexpr double kMinHitDistance = 1e-6;

template <HasShape T>
struct Hit {
  const T* item = nullptr;
  double distance = 0;  // along the ray, scene units
  Eigen::Vector3d x_in_world;
  Eigen::Vector3d normal_in_world;  // unit, on the side that the ray comes from
};

// The closest hit of a ray; nullopt if there is none. Of hits at the same distance the first in the
// list is returned.
template <HasShape T>
std::optional<Hit<T>> FirstHit(const std::vector<T>& items, const Ray& ray) {
  const T* nearest = nullptr;
  Intersection best{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero()};
  for (const T& item : items) {
    const auto found = Intersect(item.shape, ray, kMinHitDistance);
    if (found && found->distance < best.distance) best = *found, nearest = &item;
  }
  if (nearest == nullptr) return std::nullopt;
  const bool from_outside = best.normal_in_world.dot(ray.direction_in_world) <= 0;
  const Eigen::Vector3d normal =
      from_outside ? best.normal_in_world : Eigen::Vector3d(-best.normal_in_world);
  return Hit<T>{nearest, best.distance,
                ray.origin_in_world + best.distance * ray.direction_in_world, normal};
}

// Whether any shape is hit closer than `distance`, less kMinHitDistance: a light or a point at that
// distance does not shadow itself.
template <HasShape T>
bool IsBlocked(const std::vector<T>& items, const Ray& ray,
               double distance = std::numeric_limits<double>::infinity()) {
  for (const T& item : items) {
    const auto found = Intersect(item.shape, ray, kMinHitDistance);
    if (found && found->distance < distance - kMinHitDistance) return true;
  }
  return false;
}

}  // namespace nerf
