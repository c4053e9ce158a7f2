#pragma once

#include <Eigen/Core>
#include <array>

#include "nerf/light/environment_map.h"

namespace nerf {

// The nine real spherical harmonics of degree 0, 1 and 2 at a unit direction, orthonormal over the
// sphere, in the order (l, m) = (0,0), (1,-1), (1,0), (1,1), (2,-2) ... (2,2).
std::array<double, 9> SphericalHarmonics(const Eigen::Vector3d& direction);

// Irradiance from an environment as a quadratic polynomial of the normal, a cheap approximation for
// diffuse surfaces: nine coefficients hold 99 % of what the cosine lobe passes of any illumination.
// The error is largest for small bright lights, behind which values can be negative.
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

// The error of ShIrradiance against the sum over all pixels of the map
// (EnvironmentMap::Irradiance), relative to the mean irradiance, over `normals` evenly spread
// normals.
struct ShError {
  double mean = 0;
  double largest = 0;
};
ShError ShIrradianceError(const EnvironmentMap& map, int normals);

}  // namespace nerf
