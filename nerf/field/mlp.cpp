#include "nerf/field/mlp.h"

#include <cmath>
#include <string>

namespace nerf {

Mlp::Mlp(const std::vector<std::int64_t>& widths, std::uint64_t seed) {
  TORCH_CHECK(widths.size() >= 2, "Mlp: needs at least an input and an output width");
  auto generator = at::make_generator<at::CPUGeneratorImpl>(seed);
  for (std::size_t i = 0; i + 1 < widths.size(); ++i) {
    auto layer = register_module(
        "layer" + std::to_string(i),
        torch::nn::Linear(torch::nn::LinearOptions(widths[i], widths[i + 1]).bias(false)));
    const double bound = std::sqrt(6.0 / static_cast<double>(widths[i]));
    const torch::NoGradGuard no_grad;
    layer->weight.uniform_(-bound, bound, generator);
    layers_.push_back(layer);
  }
}

torch::Tensor Mlp::forward(torch::Tensor x) {
  for (std::size_t i = 0; i + 1 < layers_.size(); ++i) x = torch::relu(layers_[i]->forward(x));
  return layers_.back()->forward(x);
}

std::vector<int> Mlp::Widths() const {
  std::vector<int> widths = {static_cast<int>(Weight(0).size(1))};
  for (const auto& layer : layers_) widths.push_back(static_cast<int>(layer->weight.size(0)));
  return widths;
}

}  // namespace nerf
