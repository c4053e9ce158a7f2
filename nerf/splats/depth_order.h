#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/kernels/gaussians.h"

namespace nerf {

// Sorts projections by distance, front to back. Those of equal distance are sorted by their other
// numbers, so that the result does not depend on the order of the input.
class DepthOrder {
 public:
  // Valid until the next call.
  std::span<kernels::ProjectedGaussian> Sort(std::span<const kernels::ProjectedGaussian> gaussians);

 private:
  struct Key {
    std::uint32_t distance = 0;  // the bits of a positive float have its order
    std::uint32_t index = 0;
  };
  std::vector<Key> keys_, other_;
  std::vector<kernels::ProjectedGaussian> sorted_;
};

}  // namespace nerf
