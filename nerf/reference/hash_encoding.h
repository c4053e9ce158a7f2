#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nerf/kernels/hash_encoding.h"

namespace nerf::reference {

// The entry of a vertex within its level: Mueller et al. 2022, equation 4, apart from the code that
// it checks.
std::uint32_t HashGridEntry(const kernels::HashGridLevel& level, std::uint32_t x, std::uint32_t y,
                            std::uint32_t z);

// The encoding of one position, level after level: the eight corners of its cell, interpolated axis
// by axis, in double.
//   table  [entries, features]
std::vector<double> HashEncode(const kernels::HashGridLayout& layout, std::span<const double> table,
                               const std::array<double, 3>& position);

}  // namespace nerf::reference
