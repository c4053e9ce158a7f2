#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nerf/kernels/hash_encoding.h"

namespace nerf::reference {

// The entry of a vertex within its level: Mueller et al. 2022, equation 4. Shares no code with the
// kernels that it tests.
std::uint32_t HashGridEntry(const kernels::HashGridLevel& level, std::uint32_t x, std::uint32_t y,
                            std::uint32_t z);

// The encoding of one position, level after level, in double: the eight corners of its cell,
// interpolated axis by axis.
//   table  [entries, features]
std::vector<double> HashEncode(const kernels::HashGridLayout& layout, std::span<const double> table,
                               const std::array<double, 3>& position);

}  // namespace nerf::reference
