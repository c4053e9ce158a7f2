#include "nerf/train/optimizer.h"

#include <atomic>
#include <memory>

#include "nerf/base/parallel.h"
#include "nerf/field/tensor_span.h"
#include "nerf/model/checkpoint.h"
#include "nerf/render/non_finite_error.h"

namespace nerf {
namespace {

constexpr std::int64_t kMinFloatsPerThread = 1 << 14;

// The options that LibTorch's optimizer interface requires.
struct LearningRate : torch::optim::OptimizerCloneableOptions<LearningRate> {
  explicit LearningRate(double rate) : value(rate) {}
  double get_lr() const override { return value; }
  void set_lr(const double rate) override { value = rate; }
  double value;
};

std::vector<torch::Tensor> TensorsOf(
    const std::vector<std::pair<std::string, torch::Tensor>>& parameters) {
  std::vector<torch::Tensor> tensors;
  for (const auto& [name, parameter] : parameters) tensors.push_back(parameter);
  return tensors;
}

}  // namespace

Adam::Adam(std::vector<std::pair<std::string, torch::Tensor>> parameters,
           const OptimizerOptions& options)
    : Optimizer(TensorsOf(parameters), std::make_unique<LearningRate>(options.learning_rate)),
      options_(options) {
  coefficients_.beta1 = static_cast<float>(options.beta1);
  coefficients_.beta2 = static_cast<float>(options.beta2);
  coefficients_.epsilon = static_cast<float>(options.epsilon);
  corrections_ = kernels::BiasCorrections(coefficients_);
  for (auto& [name, parameter] : parameters) {
    TORCH_CHECK(parameter.scalar_type() == torch::kFloat && parameter.is_contiguous(),
                "Adam: parameter ", name, " must be a contiguous float tensor");
    const torch::Tensor zeros = torch::zeros_like(parameter).detach();
    Slot slot = {name, parameter, zeros, zeros.clone(), {}};
    if (name.ends_with("table")) {
      TORCH_CHECK(parameter.dim() == 2, "Adam: table ", name, " must be [entries, features], got ",
                  parameter.sizes());
      slot.entry_steps = torch::zeros({parameter.size(0)}, torch::kInt);
    }
    slots_.push_back(std::move(slot));
  }
}

void Adam::Step(double learning_rate_factor) {
  for (auto& group : param_groups()) {
    group.options().set_lr(options_.learning_rate * learning_rate_factor);
  }
  step();
}

bool Adam::StepDense(const Slot& slot, const torch::Tensor& gradient) {
  kernels::AdamCoefficients adam = coefficients_;
  adam.weight_decay = static_cast<float>(options_.weight_decay);
  const auto correction = kernels::BiasCorrection(adam, steps_.item<std::int64_t>());
  const auto p = Span<float>(slot.parameter), g = Span<float>(gradient),
             m = Span<float>(slot.first_moment), v = Span<float>(slot.second_moment);
  std::atomic<bool> finite = true;
  ParallelFor(
      slot.parameter.numel(), kMinFloatsPerThread, [&](std::int64_t first, std::int64_t last) {
        const std::size_t count = last - first;
        if (!kernels::AdamStep(adam, correction, p.subspan(first, count), g.subspan(first, count),
                               m.subspan(first, count), v.subspan(first, count))) {
          finite = false;
        }
      });
  return finite;
}

bool Adam::StepSparse(const Slot& slot, const torch::Tensor& gradient) {
  const auto features = static_cast<std::int64_t>(slot.parameter.size(1));
  const auto p = Span<float>(slot.parameter), g = Span<float>(gradient),
             m = Span<float>(slot.first_moment), v = Span<float>(slot.second_moment);
  const auto n = Span<std::int32_t>(slot.entry_steps);
  std::atomic<bool> finite = true;
  ParallelFor(
      slot.parameter.size(0), kMinFloatsPerThread / features,
      [&](std::int64_t first, std::int64_t last) {
        const std::size_t at = first * features, size = (last - first) * features;
        if (!kernels::SparseAdamStep(coefficients_, static_cast<int>(features), corrections_,
                                     p.subspan(at, size), g.subspan(at, size), m.subspan(at, size),
                                     v.subspan(at, size), n.subspan(first, last - first))) {
          finite = false;
        }
      });
  return finite;
}

torch::Tensor Adam::step(LossClosure closure) {
  torch::Tensor loss;
  if (closure) {
    const torch::AutoGradMode with_gradients(true);
    loss = closure();
  }
  const torch::NoGradGuard no_grad;
  steps_ += 1;
  coefficients_.learning_rate = static_cast<float>(param_groups().front().options().get_lr());
  for (Slot& slot : slots_) {
    torch::Tensor& gradient = slot.parameter.mutable_grad();
    if (!gradient.defined()) gradient = torch::zeros_like(slot.parameter).detach();
    gradient = gradient.contiguous();
    const bool finite =
        slot.entry_steps.defined() ? StepSparse(slot, gradient) : StepDense(slot, gradient);
    if (!finite) {
      throw NonFiniteError("the gradient of " + slot.name + " is not finite, stage optimiser");
    }
  }
  return loss;
}

// The state tensors (not copies), by their names in a checkpoint.
std::map<std::string, torch::Tensor> Adam::State() const {
  std::map<std::string, torch::Tensor> state = {{"adam.steps", steps_}};
  for (const Slot& slot : slots_) {
    state["adam.m." + slot.name] = slot.first_moment;
    state["adam.v." + slot.name] = slot.second_moment;
    if (slot.entry_steps.defined()) state["adam.n." + slot.name] = slot.entry_steps;
  }
  return state;
}

void Adam::AddTo(std::map<std::string, torch::Tensor>& tensors) const { tensors.merge(State()); }

void Adam::LoadFrom(const std::map<std::string, torch::Tensor>& tensors) {
  for (const auto& [name, tensor] : State()) CopyTensor(tensors, name, tensor);
}

}  // namespace nerf
