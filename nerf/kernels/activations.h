#pragma once

#include <span>

namespace nerf::kernels {

// In place and vectorized; within 4 units in the last place of the exact functions. NaN stays NaN.

// exp(clamp(x + bias, -limit, limit)), limit <= 80.
void TruncatedExp(std::span<float> x, float bias, float limit);

// 1 / (1 + exp(-x))
void Sigmoid(std::span<float> x);

}  // namespace nerf::kernels
