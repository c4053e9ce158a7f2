#pragma once

#include <Eigen/Core>

namespace nerf {

struct Ball {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1;
};

}  // namespace nerf
