#pragma once

#include <string>
#include <utility>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/model/model.h"

namespace nerf {

// All that an optimiser moves, by the names that checkpoints use. Apart from model.h, which the
// commands read, because LibTorch's headers take seconds to compile.
std::vector<std::pair<std::string, torch::Tensor>> NamedParameters(const Model& model);

}  // namespace nerf
