#pragma once

#include "nerf/field/libtorch.h"

namespace nerf {

// exp(x), the activation of density, with the argument held to [-kExpLimit, kExpLimit]: neither the
// value nor the gradient can overflow, and the gradient never dies: outside the limits it is that
// of the nearest limit. Source: the "truncated exponential" of Mueller et al. 2022's code.
inline constexpr double kExpLimit = 15.0;
torch::Tensor TruncatedExp(const torch::Tensor& x);

}  // namespace nerf
