#include "nerf/kernels/hash_encoding.h"

#include <algorithm>
#include <cmath>

namespace nerf::kernels {
namespace {

// The cell of a position: its 8 entries and their trilinear weights, which sum to 1.
template <class Real>
struct Cell {
  std::uint32_t entry[8];
  Real weight[8];
};

template <class Real>
Cell<Real> FindCell(const HashGridLevel& level, const Real* position) {
  std::uint32_t corner[3];
  Real fraction[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Real scaled = position[axis] * static_cast<Real>(level.resolution);
    const Real floored = std::floor(scaled);
    // The far face has no cell of its own; rounding may also lift a position onto it.
    const auto last = static_cast<Real>(level.resolution - 1);
    const Real cell = std::clamp(floored, Real(0), last);
    corner[axis] = static_cast<std::uint32_t>(cell);
    fraction[axis] = scaled - cell;
  }
  Cell<Real> cell;
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
    cell.entry[k] = HashGridIndex(level, corner[0] + dx, corner[1] + dy, corner[2] + dz);
    cell.weight[k] = (dx ? fraction[0] : Real(1) - fraction[0]) *
                     (dy ? fraction[1] : Real(1) - fraction[1]) *
                     (dz ? fraction[2] : Real(1) - fraction[2]);
  }
  return cell;
}

// The number of features is a template argument so that the inner loops unroll.
template <class Real, int kFeatures>
void ForwardLevel(const HashGridLevel& level, const Real* table, const Real* positions,
                  Real* encoded, int stride, std::int64_t first, std::int64_t last) {
  for (std::int64_t i = first; i < last; ++i) {
    const Cell<Real> cell = FindCell(level, positions + 3 * i);
    Real sum[kFeatures] = {};
    for (int k = 0; k < 8; ++k) {
      const Real* entry = table + static_cast<std::int64_t>(cell.entry[k]) * kFeatures;
      for (int f = 0; f < kFeatures; ++f) sum[f] += cell.weight[k] * entry[f];
    }
    for (int f = 0; f < kFeatures; ++f) encoded[i * stride + f] = sum[f];
  }
}

template <class Real, int kFeatures>
void BackwardLevel(const HashGridLevel& level, const Real* positions, const Real* dL_dencoded,
                   int stride, Real* dL_dtable, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) {
    const Cell<Real> cell = FindCell(level, positions + 3 * i);
    for (int k = 0; k < 8; ++k) {
      Real* entry = dL_dtable + static_cast<std::int64_t>(cell.entry[k]) * kFeatures;
      for (int f = 0; f < kFeatures; ++f) entry[f] += cell.weight[k] * dL_dencoded[i * stride + f];
    }
  }
}

// Calls f with the number of features as a compile-time constant.
template <class F>
void WithFeatures(int features, F&& f) {
  switch (features) {
    case 1: return f(std::integral_constant<int, 1>());
    case 2: return f(std::integral_constant<int, 2>());
    case 4: return f(std::integral_constant<int, 4>());
    default: return f(std::integral_constant<int, 8>());
  }
}

}  // namespace

HashGridLayout MakeHashGridLayout(const HashGridOptions& options) {
  HashGridLayout layout;
  layout.features = options.features;
  const double growth =
      options.levels > 1
          ? std::log(static_cast<double>(options.max_resolution) / options.base_resolution) /
                (options.levels - 1)
          : 0.0;
  const std::int64_t most = std::int64_t{1} << options.log2_table_size;
  for (int l = 0; l < options.levels; ++l) {
    HashGridLevel level;
    // The small addend keeps exact powers from falling below themselves by rounding.
    level.resolution =
        static_cast<std::uint32_t>(options.base_resolution * std::exp(growth * l) + 1e-6);
    const std::int64_t side = level.resolution + 1;
    const std::int64_t vertices = side * side * side;
    level.dense = vertices <= most;
    level.size = static_cast<std::uint32_t>(level.dense ? vertices : most);
    level.offset = layout.entries;
    layout.entries += level.size;
    layout.levels.push_back(level);
  }
  return layout;
}

template <class Real>
void HashEncodeForward(const HashGridLayout& layout, std::span<const Real> table,
                       std::span<const Real> positions, std::span<Real> encoded,
                       std::int64_t first, std::int64_t last) {
  const int stride = layout.OutputSize();
  // Blocks of samples, levels outermost within a block: one level's table stays in the cache while
  // the block's rows of `encoded` do too.
  constexpr std::int64_t kBlock = 1024;
  for (std::int64_t begin = first; begin < last; begin += kBlock) {
    const std::int64_t end = std::min(last, begin + kBlock);
    for (std::size_t l = 0; l < layout.levels.size(); ++l) {
      const HashGridLevel& level = layout.levels[l];
      WithFeatures(layout.features, [&](auto features) {
        ForwardLevel<Real, features.value>(level, table.data() + level.offset * features.value,
                                           positions.data(),
                                           encoded.data() + l * features.value, stride, begin, end);
      });
    }
  }
}

template <class Real>
void HashEncodeBackward(const HashGridLayout& layout, std::span<const Real> positions,
                        std::span<const Real> dL_dencoded, std::span<Real> dL_dtable,
                        int first_level, int last_level) {
  const int stride = layout.OutputSize();
  const auto count = static_cast<std::int64_t>(positions.size() / 3);
  for (int l = first_level; l < last_level; ++l) {
    const HashGridLevel& level = layout.levels[l];
    WithFeatures(layout.features, [&](auto features) {
      BackwardLevel<Real, features.value>(
          level, positions.data(), dL_dencoded.data() + std::int64_t{l} * features.value, stride,
          dL_dtable.data() + level.offset * features.value, count);
    });
  }
}

#define NERF_INSTANTIATE(Real)                                                                  \
  template void HashEncodeForward(const HashGridLayout&, std::span<const Real>,                 \
                                  std::span<const Real>, std::span<Real>, std::int64_t,         \
                                  std::int64_t);                                                \
  template void HashEncodeBackward(const HashGridLayout&, std::span<const Real>,                \
                                   std::span<const Real>, std::span<Real>, int, int);
NERF_INSTANTIATE(float)
NERF_INSTANTIATE(double)
#undef NERF_INSTANTIATE

}  // namespace nerf::kernels
