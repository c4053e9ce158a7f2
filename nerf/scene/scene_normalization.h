#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "nerf/scene/posed_images.h"

namespace nerf {

// The similarity transform from the world of the input to the space in which the field is trained:
//   x_in_normalized = scale * rotation * x_in_world + translation
// There the subject of the cameras is within the unit ball about the origin, and up is +z. All
// output is transformed back into the units and frame of the input.
struct SceneNormalization {
  double scale = 1;  // normalized units per world unit
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d NormalizedFromWorld(const Eigen::Vector3d& x_in_world) const;
  Eigen::Vector3d WorldFromNormalized(const Eigen::Vector3d& x_in_normalized) const;

  // Transform poses: the result is a rigid motion, whose centre is transformed by the similarity.
  Eigen::Isometry3d NormalizedFromCamera(const Eigen::Isometry3d& world_from_camera) const;
  Eigen::Isometry3d WorldFromCamera(const Eigen::Isometry3d& normalized_from_camera) const;

  double LengthNormalizedFromWorld(double length_in_world) const { return length_in_world * scale; }
  double LengthWorldFromNormalized(double length_in_normalized) const {
    return length_in_normalized / scale;
  }
};

// Chooses centre, radius and up from the cameras.
//   Inward-facing: the centre minimizes the sum of distances to the optical axes (by iteratively
//   reweighted least squares); the radius is what a camera sees there, the median of
//   distance * sqrt(tan(horizontal half angle) * tan(vertical half angle)).
//   Forward-facing (axes nearly parallel): the centre is in front of the mean camera, at the
//   harmonic mean of depth_range_in_world, else at the median depth of the sparse points.
//   Outward-facing: the centre is the mean camera centre, the radius twice the largest distance of
//   a camera from it; with all cameras in one point, the median distance of the sparse points,
//   else 1.
// Up is the mean of the cameras' up vectors. Needs at least one image. Throws InputError naming the
// source when the cameras are too far apart or too close together for double arithmetic.
SceneNormalization NormalizeScene(const PosedImages& posed);

}  // namespace nerf
