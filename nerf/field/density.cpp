#include "nerf/field/density.h"

#include "nerf/field/activations.h"

namespace nerf {

torch::Tensor ActivateDensity(const torch::Tensor& network_output) {
  return TruncatedExp(network_output + kLogDensityBias);
}

torch::Tensor RadialShrinkage(const torch::Tensor& positions_in_cube) {
  const torch::Tensor y = 4.0 * (positions_in_cube - 0.5);
  return torch::clamp(2.0 - y.norm(2, 1), 0.0, 1.0).square();
}

}  // namespace nerf
