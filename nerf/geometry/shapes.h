#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

namespace nerf {

struct Ray {
  Eigen::Vector3d origin_in_world;
  Eigen::Vector3d direction_in_world;  // unit
};

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 1;
};

// An upright box, rotated about z so that its x axis points along `heading`.
struct Box {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size = Eigen::Vector3d::Ones();
  Eigen::Vector2d heading = Eigen::Vector2d::UnitX();  // unit
};

// A horizontal disc, normal +z.
struct Disc {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 1;
};

using Shape = std::variant<Sphere, Box, Disc>;

// The heading of a box rotated about z by an angle, counter-clockwise as seen from above.
Eigen::Vector2d HeadingFromDegrees(double degrees);

struct Intersection {
  double distance = 0;              // along the ray, scene units
  Eigen::Vector3d normal_in_world;  // unit; outward, even if the ray comes from inside
};

// The nearest intersection of a ray with the surface of a shape beyond `min_distance`.
// Sources: sphere, Haines et al. 2019, Ray Tracing Gems ch. 7 (by the distance of the centre from
// the ray, which avoids the cancellation in b^2 - 4ac); box, Kay and Kajiya 1986 (slabs).
//   returns  nullopt if there is none
std::optional<Intersection> Intersect(const Shape& shape, const Ray& ray, double min_distance = 0);

// A point in the frame of the shape, with the centre at the origin and the axes of the box.
// Textures are defined in this frame.
Eigen::Vector3d ShapeFromWorld(const Shape& shape, const Eigen::Vector3d& x_in_world);

}  // namespace nerf
