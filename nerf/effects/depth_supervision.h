#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// Depths of the sparse points of structure from motion, for captures of few photographs, which
// alone do not determine the geometry. Some rays of a batch go through sparse points, and a loss
// requires their weights to be concentrated there:
//   loss = weight / R * sum over those rays of (sum_i w_i cost_i + T_N)
// with weights w_i and final transmittance T_N. Source: after Deng et al. 2022, "Depth-supervised
// NeRF", which compares a ray's weights with a normal distribution about its point; here the robust
// cost of Geman and McClure 1985 limits the influence of wrong points.
struct DepthSupervisionOptions {
  double share = 0.1;
  double weight = 0.1;
  double delta = 0.1;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("share", o.share, "of rays", Between(0, 0.5), "rays that go through sparse points");
    option("weight", o.weight, "", AtLeast(0), "weight of the depth loss against that of colours");
    option("delta", o.delta, "relative", Above(0),
           "depth error at which the robust cost is half of its maximum");
  }
};

// Sets `depth_observations` of each training view: the points whose tracks contain the view, with
// at least three sightings and a reprojection error of at most two pixels, at the pixel to which
// the view's camera projects them.
//   sparse  with points and tracks; its images match the views by name
void AddSparseDepths(const PosedImages& sparse, const SceneNormalization& normalized_from_world,
                     Dataset& data);

// The cost of a sample at distance t on a ray whose point is at distance `target`:
// e^2 / (e^2 + delta^2) with e = t / target - 1. Far from the point it tends to 1, the cost of an
// empty ray; a lower cost there would reward fog in front of the camera.
double DepthCost(double t, double target, const DepthSupervisionOptions& options);

// The cost of each sample of a batch, 0 on rays without a target. The loss is on each sample's
// weight and not on the expected depth, which would also be right for fog around the point.
//   t, ray   [S], as in PackedSamples
//   target   [R] normalized units, 0: none
//   returns  [S]
std::vector<float> DepthCosts(std::span<const float> t, std::span<const std::int64_t> ray,
                              std::span<const float> target,
                              const DepthSupervisionOptions& options);

// On where few photographs see a point (median over points that are not far away), so that they
// alone do not determine the geometry. Undecided where all points are far away.
Verdict JudgeDepthSupervision(const PosedImages& posed,
                              const SceneNormalization& normalized_from_world);

extern const EffectDescriptor kDepthSupervisionEffect;

}  // namespace nerf
