#pragma once

#include <torch/torch.h>

#include <vector>

#include "nerf/data/dataset.h"
#include "nerf/effects/effects_options.h"
#include "sfm/posed_images.h"
#include "sfm/scene_normalization.h"

namespace nerf {

// Distances that structure from motion knows, for captures of few photographs, which alone leave
// open where matter stands. Some rays go through sparse points, and each is asked to see as far as
// its point stands. Source: Deng et al. 2022, "Depth-supervised NeRF", with Huber's loss of the
// relative error in place of a square, for some points are wrong.

// Gives each view that is trained on the points that it sees: those that three photographs have
// seen within two pixels, in the pixel to which its camera projects them.
//   sparse  with points and tracks; its images are the views by name
void AddSeenPoints(const sfm::PosedImages& sparse,
                   const sfm::SceneNormalization& normalized_from_world, Dataset& data);

// What one ray's error costs, and how the cost changes with the distance that the ray sees:
//   Huber's loss of e = distance / target - 1, by DepthOptions::delta
// A ray that sees nothing at all has the distance 0, and is drawn to see something.
struct DepthCost {
  double value = 0, derivative = 0;
};
DepthCost CostOfDepth(double distance, double target, const DepthOptions& options);

// weight times the sum of the costs of the rays that have a target, over all rays; by autograd.
//   distance  [R] sum w t of each ray    target  [R] normalized units, 0: none
torch::Tensor DepthLoss(const torch::Tensor& distance, const torch::Tensor& target,
                        const DepthOptions& options);

}  // namespace nerf
