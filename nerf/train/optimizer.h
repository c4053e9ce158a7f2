#pragma once

#include <torch/optim/optimizer.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "nerf/config/train_options.h"
#include "nerf/field/libtorch.h"
#include "nerf/kernels/adam.h"

namespace nerf {

// Adam as a LibTorch optimizer, in one pass over each parameter, on all threads.
// Source: Kingma and Ba 2015; the same results as torch::optim::Adam, which makes eight passes.
// Tables (parameters whose name ends in "table") are updated sparsely and without weight decay, see
// kernels::SparseAdamStep.
class Adam : public torch::optim::Optimizer {
 public:
  //   parameters  named, contiguous float tensors, which are updated in place; tables are
  //               [entries, features] with 1, 2, 4 or 8 features
  // Throws c10::Error on a wrong type or shape.
  Adam(std::vector<std::pair<std::string, torch::Tensor>> parameters,
       const OptimizerOptions& options);

  // One step with the configured learning rate times a factor; see step().
  void Step(double learning_rate_factor);

  // One step; sets the gradients to 0. An undefined gradient counts as 0.
  // Throws NonFiniteError naming the parameter if a gradient is not finite; parameters are then
  // invalid and must not be saved.
  torch::Tensor step(LossClosure closure = nullptr) override;

  // The optimizer's state in a checkpoint: "adam.m.NAME", "adam.v.NAME", "adam.n.NAME" (steps of
  // each entry of a table), "adam.steps".
  void AddTo(std::map<std::string, torch::Tensor>& tensors) const;
  void LoadFrom(const std::map<std::string, torch::Tensor>& tensors);

 private:
  struct Slot {
    std::string name;
    torch::Tensor parameter, first_moment, second_moment;
    torch::Tensor entry_steps;  // [entries] int32; undefined for dense updates
  };
  bool StepDense(const Slot& slot, const torch::Tensor& gradient);
  bool StepSparse(const Slot& slot, const torch::Tensor& gradient);
  std::map<std::string, torch::Tensor> State() const;

  OptimizerOptions options_;
  kernels::AdamCoefficients coefficients_;
  std::vector<kernels::AdamBiasCorrection> corrections_;
  std::vector<Slot> slots_;
  torch::Tensor steps_ = torch::zeros({}, torch::kLong);
};

}  // namespace nerf
