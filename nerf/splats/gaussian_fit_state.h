#pragma once

#include <cstdint>

#include "nerf/config/splat_options.h"
#include "nerf/splats/gaussian_cloud.h"

namespace nerf {

// All that a fit needs to go on, bit for bit.
struct GaussianFitState {
  GaussianCloud cloud;
  torch::Tensor first_moment, second_moment;  // of Adam, as the parameters
  torch::Tensor need;                         // [blocks * 16] gradient on the screen since a split
  std::int64_t step = 0;
};

// The beginning of a fit; the Gaussians are brought into a spatial order.
GaussianFitState BeginFit(const GaussianCloud& initial);

// Puts invisible Gaussians where the picture asks for more: they split others, chosen at random in
// proportion to `need`, of which two smaller ones then take the place. Sets `need` to 0.
void SplitWhereNeeded(GaussianFitState& state, const SplatOptions& options, std::uint64_t seed);

// Leaves only so many of the Gaussians, those whose opacity times area, as
// seen from the origin, is largest, in their order.
void KeepMostVisible(GaussianFitState& state, std::int64_t count);

}  // namespace nerf
