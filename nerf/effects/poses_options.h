#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace nerf {

// Poses and focal lengths that are a little wrong (Poses).
struct PosesOptions {
  double rate = 0.05;  // of learning, in radians and normalized units, for each unit of the field's

  void Check() const;
};

// Where a photograph was taken, as far as the refinement of poses must know: normalized frame.
struct CameraPlace {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit: the way its camera looks
  std::int64_t lens = 0;  // photographs with the same share a focal length
};

}  // namespace nerf
