#pragma once

#include <Eigen/Core>

namespace nerf {

// The real spherical harmonics of kernels/gaussians.h at a unit direction: [(order + 1)^2].
Eigen::VectorXd HarmonicsAt(int order, const Eigen::Vector3d& direction);

// The matrix that rotates spherical harmonics coefficients: its product with the coefficients of a
// function f(direction) gives those of the function f(rotation * direction).
//   order  0 to 3
Eigen::MatrixXd HarmonicsRotation(int order, const Eigen::Matrix3d& rotation);

}  // namespace nerf
