#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"

namespace nerf {

// Poses and focal lengths that are a little wrong, refined with the field
// (nerf/field/pose_refinement.h).
struct PoseRefinementOptions {
  double rate = 0.05;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("rate", o.rate, "", Between(0, 1),
           "learning rate of poses, in radians and normalized units, over that of the field");
  }
};

// Where a photograph was taken, as far as the refinement of poses must know: normalized frame.
struct CameraPlace {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit: the way its camera looks
  std::int64_t lens = 0;  // photographs with the same share a focal length
};

// How far points are, in the photographs, from where these cameras would see them: what structure
// from motion leaves over is a fraction of a pixel or one, and more where poses are wrong.
// Undecided where no track says where a point is seen.
Verdict JudgePoseRefinement(const PosedImages& posed);

extern const EffectDescriptor kPoseRefinement;

}  // namespace nerf
