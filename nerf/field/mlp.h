#pragma once

#include <cstdint>
#include <vector>

#include "nerf/field/libtorch.h"

namespace nerf {

// A small fully connected network: linear layers without bias, with ReLU between them.
class Mlp : public torch::nn::Module {
 public:
  // Weights are initialized He-uniform from `seed`.
  //   widths  of the input, the hidden layers and the output
  Mlp(const std::vector<std::int64_t>& widths, std::uint64_t seed);

  // x [N, inputs] -> [N, outputs]. Differentiable in the weights and in x.
  torch::Tensor forward(torch::Tensor x);

  // Widths of the input, the hidden layers and the output.
  std::vector<int> Widths() const;
  // The weights of layer l, [outputs, inputs]: the parameter "layer<l>.weight".
  const torch::Tensor& Weight(int l) const { return weights_[l]; }

 private:
  std::vector<torch::Tensor> weights_;
};

}  // namespace nerf
