#pragma once

#include <cstdint>
#include <vector>

#include "nerf/field/libtorch.h"

namespace nerf {

// A small fully connected network: linear layers without bias, ReLU between them, none at the end.
class Mlp : public torch::nn::Module {
 public:
  // widths: inputs, hidden layers, outputs. Weights start He-uniform from `seed`.
  Mlp(const std::vector<std::int64_t>& widths, std::uint64_t seed);

  // x [N, inputs] -> [N, outputs]
  torch::Tensor forward(torch::Tensor x);

  // Inputs, hidden layers, outputs.
  std::vector<int> Widths() const;
  // The weights of layer l, [outputs, inputs]: the parameter "layer0.weight" and on.
  const torch::Tensor& Weight(int l) const { return weights_[l]; }

 private:
  std::vector<torch::Tensor> weights_;
};

}  // namespace nerf
