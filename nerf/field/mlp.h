#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <vector>

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
  // The weights of layer l, [outputs, inputs].
  const torch::Tensor& Weight(int l) const { return layers_[l]->weight; }

 private:
  std::vector<torch::nn::Linear> layers_;
};

}  // namespace nerf
