#include "nerf/train/losses.h"

namespace nerf {

torch::Tensor ColorLoss(const torch::Tensor& predicted, const torch::Tensor& target,
                        const LossOptions& options) {
  TORCH_CHECK(predicted.sizes() == target.sizes(), "ColorLoss: predicted ", predicted.sizes(),
              " and target ", target.sizes(), " differ in shape");
  if (options.kind == "mse") return torch::mse_loss(predicted, target);
  return torch::huber_loss(predicted, target, at::Reduction::Mean, options.huber_delta) /
         options.huber_delta;
}

}  // namespace nerf
