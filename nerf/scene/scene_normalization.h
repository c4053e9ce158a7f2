#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "nerf/scene/posed_images.h"

namespace nerf {

// The similarity between the world of the input and the space in which the field is trained:
//   x_in_normalized = scale * rotation * x_in_world + translation
// What the cameras look at lies about the origin within a radius of 1, and up is +z. Everything
// handed out goes back through the inverse, so it is in the units and frame of the input.
struct SceneNormalization {
  double scale = 1;  // normalized units a world unit
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d NormalizedFromWorld(const Eigen::Vector3d& x_in_world) const;
  Eigen::Vector3d WorldFromNormalized(const Eigen::Vector3d& x_in_normalized) const;

  // Poses: the rotation stays a rotation, the camera centre moves with the similarity.
  Eigen::Isometry3d NormalizedFromCamera(const Eigen::Isometry3d& world_from_camera) const;
  Eigen::Isometry3d WorldFromCamera(const Eigen::Isometry3d& normalized_from_camera) const;

  double LengthNormalizedFromWorld(double length_in_world) const { return length_in_world * scale; }
  double LengthWorldFromNormalized(double length_in_normalized) const {
    return length_in_normalized / scale;
  }
};

// Chooses centre, radius and up from the cameras.
//   Looking inwards: the centre is the point nearest to all optical axes (sum of distances, by
//   iteratively reweighted least squares), the radius what a camera sees there: the median of
//   distance * sqrt(tan(horizontal half angle) * tan(vertical half angle)).
//   Looking ahead (axes nearly parallel): the centre lies before the mean camera, at the harmonic
//   mean of depth_range_in_world, else at the median depth of the sparse points.
//   Looking outwards: the centre is the mean camera centre, the radius twice the reach of the
//   cameras; with all cameras in one point the median distance of the sparse points, else 1.
// Up is the mean of the cameras' up. Throws InputError naming the source when the cameras are too
// far apart or too close together for double arithmetic. Needs at least one image.
SceneNormalization NormalizeScene(const PosedImages& posed);

}  // namespace nerf
