#pragma once

#include <optional>

#include "nerf/config/train_options.h"
#include "nerf/effects/robust.h"
#include "nerf/field/libtorch.h"

namespace nerf {

// The colour loss: the mean over rays and channels of the squared error or of the Huber loss, which
// is e^2/2 for |e| <= delta and delta (|e| - delta/2) beyond, divided by delta. Source: Huber 1964.
// With `robust`, the mean over rays of RobustLoss(l), where l is a ray's mean over channels.
//   predicted, target  [R,3]    returns  scalar
// Differentiable in predicted. Throws c10::Error on a shape mismatch.
torch::Tensor ColorLoss(const torch::Tensor& predicted, const torch::Tensor& target,
                        const LossOptions& options, const std::optional<RobustOptions>& robust);

// The weight of each ray's gradients under a robust loss: RobustWeight(l).
//   returns  [R], not differentiable
torch::Tensor RobustRayWeights(const torch::Tensor& predicted, const torch::Tensor& target,
                               const LossOptions& options, const RobustOptions& robust);

}  // namespace nerf
