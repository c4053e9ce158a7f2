#pragma once

#include <vector>

namespace nerf::reference {

// Per layer: [outputs, inputs].
using Weights = std::vector<std::vector<double>>;

// A fully connected network with ReLU between its layers and no biases, in plain loops.
//   widths  inputs, hidden layers, outputs    x  [widths[0]]    returns  [widths.back()]
std::vector<double> Mlp(const std::vector<int>& widths, const Weights& weights,
                        std::vector<double> x);

}  // namespace nerf::reference
