#pragma once

#include <torch/torch.h>

#include "nerf/train/train_options.h"

namespace nerf {

// Mean over rays and channels of the squared error, or of Huber's: e^2/2 for |e| <= delta,
// delta (|e| - delta/2) beyond, divided by delta. Source: Huber 1964.
//   predicted, target  [R,3]
torch::Tensor ColorLoss(const torch::Tensor& predicted, const torch::Tensor& target,
                        const LossOptions& options);

}  // namespace nerf
