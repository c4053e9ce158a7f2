#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/base/options.h"

namespace nerf::kernels {

// Multi-resolution hash encoding. Source: Mueller et al. 2022, "Instant Neural Graphics Primitives
// with a Multiresolution Hash Encoding", section 3.
struct HashGridOptions {
  int levels = 8;
  int features = 4;
  int log2_table_size = 17;
  int base_resolution = 16;
  int max_resolution = 2048;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("levels", o.levels, "", Between(1, 32), "resolutions of the encoding");
    option("features", o.features, "", OneOf({1, 2, 4, 8}), "numbers per entry of a table");
    option("log2_table_size", o.log2_table_size, "log2 entries", Between(8, 24),
           "most entries of a level");
    option("base_resolution", o.base_resolution, "cells", Between(1, 65536),
           "along an axis of contracted space at the coarsest level");
    option("max_resolution", o.max_resolution, "cells", Between(1, 65536), "of the finest level");
  }
};

// One level: a lattice of (resolution + 1)^3 vertices over the unit cube. Where they fit into the
// table, each vertex has its own entry ("dense"); otherwise vertices share entries by a spatial
// hash.
struct HashGridLevel {
  std::uint32_t resolution = 0;
  std::uint32_t size = 0;   // entries
  std::int64_t offset = 0;  // first entry in the table
  bool dense = false;
};

struct HashGridLayout {
  int features = 0;
  std::vector<HashGridLevel> levels;
  std::int64_t entries = 0;

  int OutputSize() const { return features * static_cast<int>(levels.size()); }
};

HashGridLayout MakeHashGridLayout(const HashGridOptions& options);

// The factors of the spatial hash. The entry of vertex (x, y, z) is
//   x ^ (y kHashPrimeY) ^ (z kHashPrimeZ) modulo the size of a hashed level,
//   x + side (y + side z), side = resolution + 1, of a dense level.
// Source: Teschner et al. 2003.
inline constexpr std::uint32_t kHashPrimeY = 2654435761u;
inline constexpr std::uint32_t kHashPrimeZ = 805459861u;

// Trilinear interpolation of the entries at the 8 corners of the cell that contains each position.
//   table      [entries, features]
//   positions  [N,3] in [0,1]; the far faces belong to the last cell
//   encoded    [N, levels * features], level after level
// Computes samples [first, last) only, so that a caller can distribute samples over threads.
// Differentiable in the table and the positions, by the two backward passes below.
template <class Real>
void HashEncodeForward(const HashGridLayout& layout, std::span<const Real> table,
                       std::span<const Real> positions, std::span<Real> encoded, std::int64_t first,
                       std::int64_t last);

// The backward pass of HashEncodeForward in the table: adds dL/dtable of all N samples for the
// levels [first_level, last_level) only. One thread owns the entries of a level, so that the
// scatter needs no atomics and is deterministic.
//   dL_dencoded  [N, levels * features]
//   dL_dtable    [entries, features], added to
template <class Real>
void HashEncodeBackward(const HashGridLayout& layout, std::span<const Real> positions,
                        std::span<const Real> dL_dencoded, std::span<Real> dL_dtable,
                        int first_level, int last_level);

// The backward pass of HashEncodeForward in the positions: adds dL/dposition of samples
// [first, last). The encoding is not differentiable across the faces of cells; on a face the
// gradient is that of the cell that contains the position.
//   dL_dencoded   rows of `row` values, row >= layout.OutputSize()
//   level_weight  [levels] factor of each level's features; a level of weight 0 is not read
//   dL_dposition  [N,3], added to
template <class Real>
void HashEncodePositionBackward(const HashGridLayout& layout, std::span<const Real> table,
                                std::span<const Real> positions, std::span<const Real> dL_dencoded,
                                std::int64_t row, std::span<const float> level_weight,
                                std::span<Real> dL_dposition, std::int64_t first,
                                std::int64_t last);

}  // namespace nerf::kernels
