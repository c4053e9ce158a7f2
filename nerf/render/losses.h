#pragma once

#include <optional>

#include "nerf/config/train_options.h"
#include "nerf/effects/robust.h"
#include "nerf/field/libtorch.h"

namespace nerf {

// Mean over rays and channels of the squared error, or of Huber's: e^2/2 for |e| <= delta,
// delta (|e| - delta/2) beyond, divided by delta. Source: Huber 1964. Where it is to be robust, the
// mean over rays of RobustLoss(l), l being a ray's mean over channels.
//   predicted, target  [R,3]
torch::Tensor ColorLoss(const torch::Tensor& predicted, const torch::Tensor& target,
                        const LossOptions& options, const std::optional<RobustOptions>& robust);

// The weight of each ray's gradients under a robust loss, [R]: RobustWeight(l). Without gradients.
torch::Tensor RobustRayWeights(const torch::Tensor& predicted, const torch::Tensor& target,
                               const LossOptions& options, const RobustOptions& robust);

}  // namespace nerf
