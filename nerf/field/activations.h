#pragma once

#include "nerf/field/libtorch.h"

namespace nerf {

// exp(x) with x clamped to [-kExpLimit, kExpLimit], the activation of density. The backward pass
// uses the clamped value, so that the gradient neither overflows nor vanishes outside the limits.
// Source: the truncated exponential in the code of Mueller et al. 2022. Any shape; differentiable.
inline constexpr double kExpLimit = 15.0;
torch::Tensor TruncatedExp(const torch::Tensor& x);

}  // namespace nerf
