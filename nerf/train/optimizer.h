#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "nerf/train/train_options.h"

namespace nerf {

// Adam in one pass over each parameter, on all threads.
// Source: Kingma and Ba 2015; the same numbers as torch::optim::Adam, without its eight passes.
class Adam {
 public:
  // parameters: named float tensors, which the optimiser updates in place. Weight decay applies to
  // all but those whose name ends in "table".
  Adam(std::vector<std::pair<std::string, torch::Tensor>> parameters,
       const OptimizerOptions& options);

  // One step along the gradients, which are dropped afterwards. A parameter without a gradient
  // counts as one whose gradient is 0.
  //   learning_rate_factor  multiplies the learning rate of the options
  // Throws NonFiniteError naming the parameter whose gradient is not finite; parameters are then
  // spoilt and must not be saved.
  void Step(double learning_rate_factor);

  // The state that a checkpoint keeps: "adam.m.NAME", "adam.v.NAME", "adam.steps".
  void AddTo(std::map<std::string, torch::Tensor>& tensors) const;
  void LoadFrom(const std::map<std::string, torch::Tensor>& tensors);

 private:
  struct Slot {
    std::string name;
    torch::Tensor parameter, first_moment, second_moment;
    float weight_decay;
  };
  OptimizerOptions options_;
  std::vector<Slot> slots_;
  std::int64_t steps_ = 0;
};

}  // namespace nerf
