#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"
#include "nerf/scene/posed_images.h"

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

// The pose of a photograph's camera, as far as pose refinement needs it; normalized frame.
struct CameraPlace {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit vector: optical axis
  std::int64_t lens = 0;  // photographs with the same index share a focal length
};

// Judges by the median reprojection error of the sparse points: up to about a pixel after
// structure from motion, more where poses are wrong. Undecided where no point has a track.
Verdict JudgePoseRefinement(const PosedImages& posed);

extern const EffectDescriptor kPoseRefinementEffect;

}  // namespace nerf
