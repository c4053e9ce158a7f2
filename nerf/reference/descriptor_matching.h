#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/kernels/descriptor_matching.h"

namespace nerf::reference {

// For each descriptor of A, the two of B with the largest scalar products; of several nearest ones
// the first.
std::vector<kernels::NearestTwo> FindNearestTwo(std::span<const std::uint8_t> a,
                                                std::span<const std::uint8_t> b);

}  // namespace nerf::reference
