#include "nerf/splats/harmonics_rotation.h"

#include <Eigen/QR>
#include <cmath>
#include <numbers>

namespace nerf {

// Source: Sloan 2013, "Efficient Spherical Harmonic Evaluation", appendix A2.
Eigen::VectorXd HarmonicsAt(int order, const Eigen::Vector3d& direction) {
  const double x = direction.x(), y = direction.y(), z = direction.z();
  const double xx = x * x, yy = y * y, zz = z * z;
  Eigen::VectorXd basis(16);
  basis << 0.28209479177387814, -0.48860251190291987 * y, 0.48860251190291987 * z,
      -0.48860251190291987 * x, 1.0925484305920792 * x * y, -1.0925484305920792 * y * z,
      0.94617469575755997 * zz - 0.31539156525251999, -1.0925484305920792 * x * z,
      0.54627421529603959 * (xx - yy), 0.59004358992664352 * y * (yy - 3 * xx),
      2.8906114426405538 * x * y * z, 0.45704579946446572 * y * (1 - 5 * zz),
      0.3731763325901154 * z * (5 * zz - 3), 0.45704579946446572 * x * (1 - 5 * zz),
      1.4453057213202769 * z * (xx - yy), 0.59004358992664352 * x * (3 * yy - xx);
  return basis.head((order + 1) * (order + 1));
}

Eigen::MatrixXd HarmonicsRotation(int order, const Eigen::Matrix3d& rotation) {
  // More directions than harmonics, spread evenly: a Fibonacci lattice.
  constexpr int kDirections = 64;
  const int count = (order + 1) * (order + 1);
  Eigen::MatrixXd here(kDirections, count), there(kDirections, count);
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Eigen::Vector3d d(r * std::cos(angle), r * std::sin(angle), z);
    here.row(i) = HarmonicsAt(order, d).transpose();
    there.row(i) = HarmonicsAt(order, rotation * d).transpose();
  }
  return here.colPivHouseholderQr().solve(there);
}

}  // namespace nerf
