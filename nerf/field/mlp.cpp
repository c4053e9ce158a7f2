#include "nerf/field/mlp.h"

#include <ATen/CPUGeneratorImpl.h>

#include <cmath>
#include <memory>
#include <string>

namespace nerf {

Mlp::Mlp(const std::vector<std::int64_t>& widths, std::uint64_t seed) {
  TORCH_CHECK(widths.size() >= 2, "Mlp: needs at least an input and an output width");
  auto generator = at::make_generator<at::CPUGeneratorImpl>(seed);
  for (std::size_t i = 0; i + 1 < widths.size(); ++i) {
    const double bound = std::sqrt(6.0 / static_cast<double>(widths[i]));
    const torch::Tensor initial =
        torch::empty({widths[i + 1], widths[i]}).uniform_(-bound, bound, generator);
    const auto layer =
        register_module("layer" + std::to_string(i), std::make_shared<torch::nn::Module>());
    weights_.push_back(layer->register_parameter("weight", initial));
  }
}

torch::Tensor Mlp::forward(torch::Tensor x) {
  for (std::size_t i = 0; i + 1 < weights_.size(); ++i) {
    x = torch::relu(torch::linear(x, weights_[i]));
  }
  return torch::linear(x, weights_.back());
}

std::vector<int> Mlp::Widths() const {
  std::vector<int> widths = {static_cast<int>(Weight(0).size(1))};
  for (const auto& weight : weights_) widths.push_back(static_cast<int>(weight.size(0)));
  return widths;
}

}  // namespace nerf
