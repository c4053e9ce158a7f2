#include "nerf/render/losses.h"

namespace nerf {

namespace {

// [R], the mean over the channels of each ray.
torch::Tensor LossOfRays(const torch::Tensor& predicted, const torch::Tensor& target,
                         const LossOptions& options) {
  TORCH_CHECK(predicted.sizes() == target.sizes(), "ColorLoss: predicted ", predicted.sizes(),
              " and target ", target.sizes(), " differ in shape");
  const torch::Tensor loss =
      options.kind == LossKind::kMse
          ? torch::mse_loss(predicted, target, at::Reduction::None)
          : torch::huber_loss(predicted, target, at::Reduction::None, options.huber_delta) /
                options.huber_delta;
  return loss.mean(1);
}

}  // namespace

torch::Tensor ColorLoss(const torch::Tensor& predicted, const torch::Tensor& target,
                        const LossOptions& options, const std::optional<RobustOptions>& robust) {
  const torch::Tensor of_ray = LossOfRays(predicted, target, options);
  return (robust ? RobustLoss(of_ray, *robust) : of_ray).mean();
}

torch::Tensor RobustRayWeights(const torch::Tensor& predicted, const torch::Tensor& target,
                               const LossOptions& options, const RobustOptions& robust) {
  const torch::NoGradGuard no_grad;
  return RobustWeight(LossOfRays(predicted, target, options), robust);
}

}  // namespace nerf
