#pragma once

#include <Eigen/Core>
#include <numbers>

#include "nerf/image/color.h"

namespace nerf {

// A light at infinity.
struct DirectionalLight {
  Eigen::Vector3d to_light = Eigen::Vector3d::UnitZ();   // unit, from the subject to the light
  Color irradiance = Color::Constant(std::numbers::pi);  // on a surface that faces it; W / m^2
};

// An isotropic point light.
struct PointLight {
  Eigen::Vector3d x_in_world = Eigen::Vector3d::Zero();
  Color intensity = Color::Ones();  // W / sr
};

// The light of a point light at x: its direction and distance, and the irradiance on a surface that
// faces it, I / d^2. `x_in_world` must not be the position of the light.
struct IncidentLight {
  Eigen::Vector3d to_light;  // unit
  double distance = 0;
  Color irradiance;
};
inline IncidentLight IncidentFrom(const PointLight& light, const Eigen::Vector3d& x_in_world) {
  const Eigen::Vector3d to_light = light.x_in_world - x_in_world;
  const double distance2 = to_light.squaredNorm();
  const double distance = std::sqrt(distance2);
  return {to_light / distance, distance, light.intensity / distance2};
}

}  // namespace nerf
