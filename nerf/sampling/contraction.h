#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace nerf {

// Contracts space into the ball of radius 2: the identity inside the unit ball, (2 - 1/|x|) x/|x|
// outside. Continuously differentiable.
// Source: Barron et al. 2022, "Mip-NeRF 360", equation 10.
inline Eigen::Vector3f Contract(const Eigen::Vector3f& x) {
  const float r = x.stableNorm();
  if (r <= 1.0f) return x;
  return ((2.0f - 1.0f / r) / r) * x;
}

// The inverse of Contract, |y| < 2.
inline Eigen::Vector3f Uncontract(const Eigen::Vector3f& y) {
  const float q = y.stableNorm();
  if (q <= 1.0f) return y;
  return y / (q * (2.0f - q));
}

// The speed of the contracted point as x moves along the unit vector d: |J(x) d|, with J the
// Jacobian of Contract. It scales radial lengths by 1/r^2 and tangential ones by (2 - 1/r)/r.
inline float ContractedSpeed(const Eigen::Vector3f& x, const Eigen::Vector3f& d) {
  const float r = x.stableNorm();
  if (r <= 1.0f) return 1.0f;
  const float radial = x.dot(d) / r;
  const float tangential2 = std::max(0.0f, 1.0f - radial * radial);
  const float along = radial / (r * r);
  const float across = (2.0f - 1.0f / r) / r;
  return std::sqrt(along * along + across * across * tangential2);
}

// The cube [-2,2]^3 around contracted space, mapped to the unit cube of encodings and grids.
inline Eigen::Vector3f UnitCubeFromContracted(const Eigen::Vector3f& y) {
  return (0.25f * y).array() + 0.5f;
}
inline Eigen::Vector3f ContractedFromUnitCube(const Eigen::Vector3f& u) {
  return 4.0f * (u.array() - 0.5f).matrix();
}

}  // namespace nerf
