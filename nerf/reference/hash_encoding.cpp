#include "nerf/reference/hash_encoding.h"

#include <algorithm>
#include <cmath>

namespace nerf::reference {

std::uint32_t HashGridEntry(const kernels::HashGridLevel& level, std::uint32_t x, std::uint32_t y,
                            std::uint32_t z) {
  const std::uint64_t side = level.resolution + 1;
  if (side * side * side <= level.size) {
    return static_cast<std::uint32_t>(x + side * (y + side * z));
  }
  const std::uint32_t hash = x ^ (y * 2654435761u) ^ (z * 805459861u);
  return hash % level.size;
}

std::vector<double> HashEncode(const kernels::HashGridLayout& layout, std::span<const double> table,
                               const std::array<double, 3>& position) {
  std::vector<double> encoded;
  for (const kernels::HashGridLevel& level : layout.levels) {
    std::uint32_t corner[3];
    double fraction[3];
    for (int a = 0; a < 3; ++a) {
      const double scaled = position[a] * level.resolution;
      corner[a] = std::min(static_cast<std::uint32_t>(scaled), level.resolution - 1);
      fraction[a] = scaled - corner[a];
    }
    for (int feature = 0; feature < layout.features; ++feature) {
      const auto at = [&](int x, int y, int z) {
        const std::int64_t entry =
            level.offset + HashGridEntry(level, corner[0] + x, corner[1] + y, corner[2] + z);
        return table[entry * layout.features + feature];
      };
      const auto along_x = [&](int y, int z) {
        return std::lerp(at(0, y, z), at(1, y, z), fraction[0]);
      };
      const auto along_y = [&](int z) {
        return std::lerp(along_x(0, z), along_x(1, z), fraction[1]);
      };
      encoded.push_back(std::lerp(along_y(0), along_y(1), fraction[2]));
    }
  }
  return encoded;
}

}  // namespace nerf::reference
