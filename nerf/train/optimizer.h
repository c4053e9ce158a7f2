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

// Adam in one pass over each parameter, on all threads, as an optimiser of LibTorch's.
// Source: Kingma and Ba 2015; the same numbers as torch::optim::Adam, without its eight passes.
// Hash tables, those parameters whose name ends in "table", are updated sparsely and without weight
// decay (kernels::SparseAdamStep).
class Adam : public torch::optim::Optimizer {
 public:
  // parameters: named float tensors, which the optimiser updates in place; tables are
  // [entries, features] with 1, 2, 4 or 8 features.
  Adam(std::vector<std::pair<std::string, torch::Tensor>> parameters,
       const OptimizerOptions& options);

  // One step with the learning rate of the options times a factor, see step().
  void Step(double learning_rate_factor);

  // One step along the gradients, which are 0 afterwards. A parameter without a gradient counts as
  // one whose gradient is 0.
  // Throws NonFiniteError naming the parameter whose gradient is not finite; parameters are then
  // invalid and must not be saved.
  torch::Tensor step(LossClosure closure = nullptr) override;

  // The state that a checkpoint keeps: "adam.m.NAME", "adam.v.NAME", "adam.n.NAME" (the steps of
  // each entry of a table), "adam.steps".
  void AddTo(std::map<std::string, torch::Tensor>& tensors) const;
  void LoadFrom(const std::map<std::string, torch::Tensor>& tensors);

 private:
  struct Slot {
    std::string name;
    torch::Tensor parameter, first_moment, second_moment;
    torch::Tensor entry_steps;  // [entries] int32; undefined where updates are dense
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
