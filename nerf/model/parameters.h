#pragma once

#include <string>
#include <utility>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/model/model.h"

namespace nerf {

// All trainable parameters, by their names in checkpoints. Not in model.h, which the commands
// include, because LibTorch's headers take seconds to compile.
std::vector<std::pair<std::string, torch::Tensor>> NamedParameters(const Model& model);

}  // namespace nerf
