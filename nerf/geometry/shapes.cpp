#include "nerf/geometry/shapes.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace nerf {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d BoxFromWorldDirection(const Box& box, const Vector3d& v) {
  const Vector2d& h = box.heading;
  return {h.x() * v.x() + h.y() * v.y(), h.x() * v.y() - h.y() * v.x(), v.z()};
}

Vector3d WorldFromBoxDirection(const Box& box, const Vector3d& v) {
  const Vector2d& h = box.heading;
  return {h.x() * v.x() - h.y() * v.y(), h.y() * v.x() + h.x() * v.y(), v.z()};
}

std::optional<Intersection> IntersectShape(const Sphere& sphere, const Ray& ray,
                                           double min_distance) {
  const Vector3d to_center = sphere.center - ray.origin_in_world;
  const double nearest = to_center.dot(ray.direction_in_world);
  const double distance2 = (to_center - nearest * ray.direction_in_world).squaredNorm();
  const double half_chord2 = sphere.radius * sphere.radius - distance2;
  if (half_chord2 < 0) return std::nullopt;
  const double half_chord = std::sqrt(half_chord2);
  double distance = nearest - half_chord;
  if (distance <= min_distance) distance = nearest + half_chord;
  if (distance <= min_distance) return std::nullopt;
  return Intersection{distance, (distance * ray.direction_in_world - to_center) / sphere.radius};
}

std::optional<Intersection> IntersectShape(const Box& box, const Ray& ray, double min_distance) {
  const Vector3d o = BoxFromWorldDirection(box, ray.origin_in_world - box.center);
  const Vector3d d = BoxFromWorldDirection(box, ray.direction_in_world);
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int enter_axis = 0;
  int leave_axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0) {
      if (std::abs(o[axis]) > box.half_size[axis]) return std::nullopt;
      continue;
    }
    const double side = std::copysign(box.half_size[axis], d[axis]);
    const double first = (-side - o[axis]) / d[axis];
    const double last = (side - o[axis]) / d[axis];
    if (first > enter) enter = first, enter_axis = axis;
    if (last < leave) leave = last, leave_axis = axis;
  }
  if (enter > leave || leave <= min_distance) return std::nullopt;
  const bool from_outside = enter > min_distance;
  const int axis = from_outside ? enter_axis : leave_axis;
  Vector3d normal = Vector3d::Zero();
  normal[axis] = std::copysign(1.0, d[axis]) * (from_outside ? -1 : 1);
  return Intersection{from_outside ? enter : leave, WorldFromBoxDirection(box, normal)};
}

std::optional<Intersection> IntersectShape(const Disc& disc, const Ray& ray, double min_distance) {
  const Vector3d to_center = disc.center - ray.origin_in_world;
  const double dz = ray.direction_in_world.z();
  if (dz == 0) return std::nullopt;
  const double distance = to_center.z() / dz;
  if (!(distance > min_distance)) return std::nullopt;
  const Vector3d from_center = distance * ray.direction_in_world - to_center;
  if (from_center.head<2>().squaredNorm() > disc.radius * disc.radius) return std::nullopt;
  return Intersection{distance, Vector3d::UnitZ()};
}

}  // namespace

Vector2d HeadingFromDegrees(double degrees) {
  const double radians = degrees * std::numbers::pi / 180;
  return {std::cos(radians), std::sin(radians)};
}

std::optional<Intersection> Intersect(const Shape& shape, const Ray& ray, double min_distance) {
  return std::visit([&](const auto& s) { return IntersectShape(s, ray, min_distance); }, shape);
}

Vector3d ShapeFromWorld(const Shape& shape, const Vector3d& x_in_world) {
  return std::visit(
      [&](const auto& s) -> Vector3d {
        const Vector3d from_center = x_in_world - s.center;
        if constexpr (std::is_same_v<std::decay_t<decltype(s)>, Box>) {
          return BoxFromWorldDirection(s, from_center);
        } else {
          return from_center;
        }
      },
      shape);
}

}  // namespace nerf
