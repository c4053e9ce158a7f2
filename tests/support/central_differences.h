#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "nerf/field/libtorch.h"

namespace nerf::test {

// Compares autograd's gradient of a scalar function with central differences, for at most `entries`
// entries spread over the tensor. `x` must be a leaf of type double that requires gradients.
inline void ExpectGradientMatchesCentralDifferences(const std::function<torch::Tensor()>& f,
                                                    torch::Tensor x, double h, double tolerance,
                                                    std::int64_t entries = 50) {
  if (x.grad().defined()) x.mutable_grad() = torch::Tensor();
  f().backward();
  const torch::Tensor gradient = x.grad().clone().view(-1);
  const torch::NoGradGuard no_grad;
  torch::Tensor flat = x.view(-1);
  const std::int64_t stride = std::max<std::int64_t>(1, flat.numel() / entries);
  for (std::int64_t i = 0; i < flat.numel(); i += stride) {
    const double at = flat[i].item<double>();
    flat[i] = at + h;
    const double above = f().item<double>();
    flat[i] = at - h;
    const double below = f().item<double>();
    flat[i] = at;
    const double numeric = (above - below) / (2 * h);
    EXPECT_NEAR(gradient[i].item<double>(), numeric, tolerance * (1 + std::abs(numeric)))
        << "entry " << i;
  }
}

}  // namespace nerf::test
