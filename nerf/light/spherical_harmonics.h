#pragma once

#include <Eigen/Core>
#include <array>

#include "nerf/light/environment_map.h"

namespace nerf {

// The nine real spherical harmonics of degree 0, 1 and 2 at a unit direction, orthonormal over the
// sphere; order (l, m) = (0,0), (1,-1), (1,0), (1,1), (2,-2) ... (2,2).
std::array<double, 9> SphericalHarmonics(const Eigen::Vector3d& direction);

// Irradiance as a quadratic polynomial of the normal: the cheap path from an environment to matt
// surfaces. Nine numbers hold 99 % of what the cosine lets through of any light; the rest is the
// error (sharp lights cause most of it, and some negative values behind them).
// Source: Ramamoorthi and Hanrahan 2001, E(n) = sum over l, m of A_l L_lm Y_lm(n),
// A = pi, 2 pi / 3, pi / 4.
class ShIrradiance {
 public:
  explicit ShIrradiance(const EnvironmentMap& map);
  // W / m^2; may be slightly negative.
  Color At(const Eigen::Vector3d& normal) const;

 private:
  std::array<Color, 9> coefficients_;  // A_l L_lm
};

// How far it is from the full integral over the map, relative to the mean irradiance, over
// `normals` evenly spread normals.
struct ShError {
  double mean = 0;
  double largest = 0;
};
ShError ShIrradianceError(const EnvironmentMap& map, int normals);

}  // namespace nerf
