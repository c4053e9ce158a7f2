#pragma once

#include <Eigen/Core>

namespace nerf {

// The real spherical harmonics of kernels/gaussians.h at a unit direction: [(order + 1)^2].
Eigen::VectorXd HarmonicsAt(int order, const Eigen::Vector3d& direction);

// The matrix that turns coefficients c of harmonics into another frame: with c' = M c,
//   sum_k c'_k basis_k(d) = sum_k c_k basis_k(rotation d)  for every direction d.
//   order  0 to 3
Eigen::MatrixXd HarmonicsRotation(int order, const Eigen::Matrix3d& rotation);

}  // namespace nerf
