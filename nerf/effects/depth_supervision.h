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

// Distances that structure from motion knows, for captures of few photographs, which alone leave
// open where matter stands. Some rays go through sparse points, and their light is asked to come
// from there:
//   loss = weight / R * sum over those rays of (sum_i w_i cost_i + T_N)
// Source: after Deng et al. 2022, "Depth-supervised NeRF", which compares a ray's weights with a
// normal distribution about its point; the cost of Geman and McClure 1985 lets points that are
// wrong pull little.
struct DepthSupervisionOptions {
  double share = 0.1;
  double weight = 0.1;
  double delta = 0.1;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("share", o.share, "of rays", Between(0, 0.5), "rays that go through sparse points");
    option("weight", o.weight, "", AtLeast(0), "weight of the depth loss against that of colours");
    option("delta", o.delta, "relative", Above(0), "depth error that costs half of the most");
  }
};

// Gives each view that is trained on the points that it sees, and no others: those that three
// photographs have seen within two pixels, in the pixel to which its camera projects them.
//   sparse  with points and tracks; its images are the views by name
void AddSparseDepths(const PosedImages& sparse, const SceneNormalization& normalized_from_world,
                     Dataset& data);

// What it costs that light comes from a distance t where a point stands at `target`:
// e^2 / (e^2 + delta^2) with e = t / target - 1. Far from the point as much as seeing nothing, 1:
// were it cheaper there, it would draw fog before the camera.
double DepthCost(double t, double target, const DepthSupervisionOptions& options);

// The cost of each sample of a batch, 0 on rays without a target. Each part of a ray's light pays
// for where it comes from, and light from nowhere pays 1: a mean distance that is right would be as
// cheap in fog before and behind the point.
//   t, ray  [S], as in PackedSamples    target  [R] normalized units, 0: none
std::vector<float> DepthCosts(std::span<const float> t, std::span<const std::int64_t> ray,
                              std::span<const float> target,
                              const DepthSupervisionOptions& options);

// Whether photographs alone leave open where matter stands, of what is not far.
Verdict JudgeDepthSupervision(const PosedImages& posed,
                              const SceneNormalization& normalized_from_world);

extern const EffectDescriptor kDepthSupervision;

}  // namespace nerf
