#pragma once

#include <cstdint>
#include <span>
#include <vector>

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
struct DepthOptions {
  double share = 0.1;   // of the rays, which go through points
  double weight = 0.1;  // of their distances' loss against that of colours
  double delta = 0.1;   // relative error that costs half of the most

  void Check() const;
};

// Gives each view that is trained on the points that it sees, and no others: those that three
// photographs have seen within two pixels, in the pixel to which its camera projects them.
//   sparse  with points and tracks; its images are the views by name
void AddSeenPoints(const PosedImages& sparse, const SceneNormalization& normalized_from_world,
                   Dataset& data);

// What it costs that light comes from a distance t where a point stands at `target`:
// e^2 / (e^2 + delta^2) with e = t / target - 1. Far from the point as much as seeing nothing, 1:
// were it cheaper there, it would draw fog before the camera.
double CostOfDistance(double t, double target, const DepthOptions& options);

// The cost of each sample of a batch, 0 on rays without a target. Each part of a ray's light pays
// for where it comes from, and light from nowhere pays 1: a mean distance that is right would be as
// cheap in fog before and behind the point.
//   t, ray  [S], as in PackedSamples    target  [R] normalized units, 0: none
std::vector<float> CostsOfSamples(std::span<const float> t, std::span<const std::int64_t> ray,
                                  std::span<const float> target, const DepthOptions& options);

}  // namespace nerf
