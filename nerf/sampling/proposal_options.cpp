#include "nerf/sampling/proposal_options.h"

#include <cmath>

#include "nerf/base/input_error.h"

namespace nerf {

void ProposalOptions::Check() const {
  const auto require_range = [](const char* key, int value, int low, int high) {
    if (value >= low && value <= high) return;
    throw InputError("config: proposal.{} is {}; use {} to {}", key, value, low, high);
  };
  require_range("intervals", intervals, 2, 1024);
  require_range("samples", samples, 1, 1024);
  require_range("hidden_width", hidden_width, 1, 256);
  require_range("anneal_steps", anneal_steps, 0, 1 << 24);
  if (!(padding > 0 && padding <= 1)) {
    throw InputError("config: proposal.padding is {}; use a value above 0, at most 1", padding);
  }
  for (const auto& [key, value] :
       {std::pair{"loss_weight", loss_weight}, {"distortion", distortion}}) {
    if (!(value >= 0 && std::isfinite(value))) {
      throw InputError("config: proposal.{} is {}; use 0 or more", key, value);
    }
  }
}

}  // namespace nerf
