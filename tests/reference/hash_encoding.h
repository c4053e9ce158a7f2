#pragma once

#include <array>
#include <span>
#include <vector>

#include "nerf/kernels/hash_encoding.h"

namespace nerf::reference {

// The encoding of one position, level after level: the eight corners of its cell, interpolated axis
// by axis, in double.
//   table  [entries, features]
std::vector<double> HashEncode(const kernels::HashGridLayout& layout, std::span<const double> table,
                               const std::array<double, 3>& position);

}  // namespace nerf::reference
