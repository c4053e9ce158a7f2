#pragma once

#include <Eigen/Core>
#include <numbers>

#include "nerf/image/color.h"

namespace nerf {

// Light from infinitely far away.
struct DirectionalLight {
  Eigen::Vector3d to_light = Eigen::Vector3d::UnitZ();   // unit, from the subject to the light
  Color irradiance = Color::Constant(std::numbers::pi);  // on a surface that faces it; W / m^2
};

// Light from a point, alike to all sides.
struct PointLight {
  Eigen::Vector3d x_in_world = Eigen::Vector3d::Zero();
  Color intensity = Color::Ones();  // W / sr
};

// What arrives at x from a point light: its direction, distance, and the irradiance on a surface
// there that faces it, I / d^2. `x_in_world` must not be the light's own place.
struct ArrivingLight {
  Eigen::Vector3d to_light;  // unit
  double distance = 0;
  Color irradiance;
};
inline ArrivingLight Arriving(const PointLight& light, const Eigen::Vector3d& x_in_world) {
  const Eigen::Vector3d way = light.x_in_world - x_in_world;
  const double distance2 = way.squaredNorm();
  const double distance = std::sqrt(distance2);
  return {way / distance, distance, light.intensity / distance2};
}

}  // namespace nerf
