#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace nerf {

// Sampling of directions from uniform numbers in [0,1)^2, and frames of normals. Unit vectors only.

// Uniform over the sphere; density 1 / (4 pi).
inline Eigen::Vector3d UniformOnSphere(const Eigen::Array2d& u) {
  const double z = 1 - 2 * u.x();
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  const double phi = 2 * std::numbers::pi * u.y();
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// About +z with density cos(theta) / pi: points of a disc projected onto the hemisphere.
// Source: Malley 1988.
inline Eigen::Vector3d CosineOnHemisphere(const Eigen::Array2d& u) {
  const double r = std::sqrt(u.x());
  const double phi = 2 * std::numbers::pi * u.y();
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x())};
}

// The half vector of two directions; finite even if both are grazing.
inline Eigen::Vector3d HalfVector(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) {
  return (w_o + w_i).stableNormalized();
}

// The i-th of n directions that are spread evenly over the sphere.
// Source: Gonzalez 2010, "Measurement of Areas on a Sphere Using Fibonacci Lattices".
inline Eigen::Vector3d FibonacciDirection(int i, int n) {
  constexpr double kGoldenAngle = 2.399963229728653;
  const double z = 1 - (2 * i + 1.0) / n;
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(kGoldenAngle * i), r * std::sin(kGoldenAngle * i), z};
}

// The rotation world_from_surface of a frame whose z axis is the normal.
// Source: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
inline Eigen::Matrix3d WorldFromSurface(const Eigen::Vector3d& normal) {
  const double sign = std::copysign(1.0, normal.z());
  const double a = -1 / (sign + normal.z());
  const double b = normal.x() * normal.y() * a;
  Eigen::Matrix3d axes;
  axes.col(0) << 1 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x();
  axes.col(1) << b, sign + normal.y() * normal.y() * a, -normal.y();
  axes.col(2) = normal;
  return axes;
}

}  // namespace nerf
