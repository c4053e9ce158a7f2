#include "nerf/train/optimizer.h"

#include <atomic>
#include <cmath>

#include "nerf/field/tensor_span.h"
#include "nerf/kernels/adam.h"
#include "nerf/parallel.h"
#include "nerf/train/checkpoint.h"
#include "nerf/train/non_finite_error.h"

namespace nerf {

Adam::Adam(std::vector<std::pair<std::string, torch::Tensor>> parameters,
           const OptimizerOptions& options)
    : options_(options) {
  for (auto& [name, parameter] : parameters) {
    TORCH_CHECK(parameter.scalar_type() == torch::kFloat && parameter.is_contiguous(),
                "Adam: parameter ", name, " must be a contiguous float tensor");
    const torch::Tensor zeros = torch::zeros_like(parameter).detach();
    slots_.push_back({name, parameter, zeros, zeros.clone(),
                      name.ends_with("table") ? 0.0f : static_cast<float>(options.weight_decay)});
  }
}

void Adam::Step(double learning_rate_factor) {
  const torch::NoGradGuard no_grad;
  ++steps_;
  kernels::AdamCoefficients adam;
  adam.learning_rate = static_cast<float>(options_.learning_rate * learning_rate_factor);
  adam.beta1 = static_cast<float>(options_.beta1);
  adam.beta2 = static_cast<float>(options_.beta2);
  adam.epsilon = static_cast<float>(options_.epsilon);
  const auto steps = static_cast<double>(steps_);
  adam.bias_correction1 = static_cast<float>(1.0 - std::pow(options_.beta1, steps));
  adam.bias_correction2 = static_cast<float>(1.0 - std::pow(options_.beta2, steps));
  for (Slot& slot : slots_) {
    adam.weight_decay = slot.weight_decay;
    torch::Tensor gradient = slot.parameter.grad();
    if (!gradient.defined()) gradient = torch::zeros_like(slot.parameter);
    gradient = gradient.contiguous();
    const auto p = Span<float>(slot.parameter), m = Span<float>(slot.first_moment),
               v = Span<float>(slot.second_moment);
    const auto g = Span<const float>(gradient);
    std::atomic<bool> finite = true;
    ParallelFor(slot.parameter.numel(), 1 << 14, [&](std::int64_t first, std::int64_t last) {
      const std::size_t count = last - first;
      if (!kernels::AdamStep(adam, p.subspan(first, count), g.subspan(first, count),
                             m.subspan(first, count), v.subspan(first, count))) {
        finite = false;
      }
    });
    if (!finite) {
      throw NonFiniteError("the gradient of " + slot.name + " is not finite, stage optimiser");
    }
    slot.parameter.mutable_grad() = torch::Tensor();
  }
}

void Adam::AddTo(std::map<std::string, torch::Tensor>& tensors) const {
  for (const Slot& slot : slots_) {
    tensors["adam.m." + slot.name] = slot.first_moment;
    tensors["adam.v." + slot.name] = slot.second_moment;
  }
  tensors["adam.steps"] = torch::tensor(steps_, torch::kLong);
}

void Adam::LoadFrom(const std::map<std::string, torch::Tensor>& tensors) {
  for (Slot& slot : slots_) {
    CopyTensor(tensors, "adam.m." + slot.name, slot.first_moment);
    CopyTensor(tensors, "adam.v." + slot.name, slot.second_moment);
  }
  torch::Tensor steps = torch::tensor(std::int64_t{0}, torch::kLong);
  CopyTensor(tensors, "adam.steps", steps);
  steps_ = steps.item<std::int64_t>();
}

}  // namespace nerf
