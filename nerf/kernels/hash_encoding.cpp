#include "nerf/kernels/hash_encoding.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace nerf::kernels {
namespace {

// The cell of a position: its 8 entries and their trilinear weights, which sum to 1. Corner k is at
// x + (k & 1), y + (k >> 1 & 1), z + (k >> 2).
template <class Real>
struct Cell {
  std::uint32_t entry[8];
  Real weight[8];
  Real along[3][2];  // the linear weights of each axis, whose products the weights are
};

// The number of features and the kind of level are template arguments, so that the loops over
// corners and features are unrolled and contain no branches.
template <class Real, bool kDense>
inline Cell<Real> FindCell(const HashGridLevel& level, const Real* position) {
  std::uint32_t corner[3];
  Real fraction[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Real scaled = position[axis] * static_cast<Real>(level.resolution);
    // Positions are not negative, so truncation rounds down. The far face belongs to the last cell.
    const auto cell = std::min(static_cast<std::int32_t>(scaled),
                               static_cast<std::int32_t>(level.resolution) - 1);
    corner[axis] = static_cast<std::uint32_t>(cell);
    fraction[axis] = scaled - static_cast<Real>(cell);
  }
  // The index is the sum (dense) or the exclusive or (hashed) of one term per axis.
  const std::uint32_t side = level.resolution + 1;
  const std::uint32_t stride_y = kDense ? side : kHashPrimeY;
  const std::uint32_t stride_z = kDense ? side * side : kHashPrimeZ;
  const std::uint32_t x[2] = {corner[0], corner[0] + 1};
  const std::uint32_t y[2] = {corner[1] * stride_y, (corner[1] + 1) * stride_y};
  const std::uint32_t z[2] = {corner[2] * stride_z, (corner[2] + 1) * stride_z};
  const Real wx[2] = {Real(1) - fraction[0], fraction[0]};
  const Real wy[2] = {Real(1) - fraction[1], fraction[1]};
  const Real wz[2] = {Real(1) - fraction[2], fraction[2]};
  Cell<Real> cell = {{}, {}, {{wx[0], wx[1]}, {wy[0], wy[1]}, {wz[0], wz[1]}}};
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
    cell.entry[k] = kDense ? x[dx] + y[dy] + z[dz] : (x[dx] ^ y[dy] ^ z[dz]) & (level.size - 1);
    cell.weight[k] = wx[dx] * (wy[dy] * wz[dz]);
  }
  return cell;
}

template <class Real, int kFeatures, bool kDense>
void ForwardLevel(const HashGridLevel& level, const Real* table, const Real* positions,
                  Real* encoded, int stride, std::int64_t first, std::int64_t last) {
  for (std::int64_t i = first; i < last; ++i) {
    const Cell<Real> cell = FindCell<Real, kDense>(level, positions + 3 * i);
    Real sum[kFeatures] = {};
    for (int k = 0; k < 8; ++k) {
      const Real* entry = table + static_cast<std::int64_t>(cell.entry[k]) * kFeatures;
      for (int f = 0; f < kFeatures; ++f) sum[f] += cell.weight[k] * entry[f];
    }
    for (int f = 0; f < kFeatures; ++f) encoded[i * stride + f] = sum[f];
  }
}

template <class Real, int kFeatures, bool kDense>
void BackwardLevel(const HashGridLevel& level, const Real* positions, const Real* dL_dencoded,
                   int stride, Real* dL_dtable, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) {
    const Cell<Real> cell = FindCell<Real, kDense>(level, positions + 3 * i);
    for (int k = 0; k < 8; ++k) {
      Real* entry = dL_dtable + static_cast<std::int64_t>(cell.entry[k]) * kFeatures;
      for (int f = 0; f < kFeatures; ++f) entry[f] += cell.weight[k] * dL_dencoded[i * stride + f];
    }
  }
}

template <class Real, int kFeatures, bool kDense>
void PositionBackwardLevel(const HashGridLevel& level, const Real* table, const Real* positions,
                           const Real* dL_dencoded, std::int64_t row, Real level_weight,
                           Real* dL_dposition, std::int64_t first, std::int64_t last) {
  const Real slope = level_weight * static_cast<Real>(level.resolution);
  for (std::int64_t i = first; i < last; ++i) {
    const Cell<Real> cell = FindCell<Real, kDense>(level, positions + 3 * i);
    Real dL_dweight[8] = {};
    for (int k = 0; k < 8; ++k) {
      const Real* entry = table + static_cast<std::int64_t>(cell.entry[k]) * kFeatures;
      for (int f = 0; f < kFeatures; ++f) dL_dweight[k] += dL_dencoded[i * row + f] * entry[f];
    }
    // The derivative along an axis is the difference across the cell, interpolated in the other
    // two.
    for (int axis = 0; axis < 3; ++axis) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      Real sum = 0;
      for (int db = 0; db < 2; ++db) {
        for (int dc = 0; dc < 2; ++dc) {
          const int low = db << b | dc << c, high = low | 1 << axis;
          sum += cell.along[b][db] * cell.along[c][dc] * (dL_dweight[high] - dL_dweight[low]);
        }
      }
      dL_dposition[3 * i + axis] += slope * sum;
    }
  }
}

// Calls f with the number of features and the kind of level as compile-time constants.
template <class F>
void Specialize(int features, bool dense, F&& f) {
  const auto with_features = [&](auto count) {
    dense ? f(count, std::true_type()) : f(count, std::false_type());
  };
  switch (features) {
    case 1:
      return with_features(std::integral_constant<int, 1>());
    case 2:
      return with_features(std::integral_constant<int, 2>());
    case 4:
      return with_features(std::integral_constant<int, 4>());
    default:
      return with_features(std::integral_constant<int, 8>());
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
    // The small addend keeps rounding from truncating exact powers to the integer below.
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
                       std::span<const Real> positions, std::span<Real> encoded, std::int64_t first,
                       std::int64_t last) {
  const int stride = layout.OutputSize();
  // Blocks of samples with levels as the outer loop, so that the table of a level and the block's
  // rows of `encoded` both stay in the cache.
  constexpr std::int64_t kBlock = 1024;
  for (std::int64_t begin = first; begin < last; begin += kBlock) {
    const std::int64_t end = std::min(last, begin + kBlock);
    for (std::size_t l = 0; l < layout.levels.size(); ++l) {
      const HashGridLevel& level = layout.levels[l];
      Specialize(layout.features, level.dense, [&](auto features, auto dense) {
        ForwardLevel<Real, features.value, dense.value>(
            level, table.data() + level.offset * features.value, positions.data(),
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
    Specialize(layout.features, level.dense, [&](auto features, auto dense) {
      BackwardLevel<Real, features.value, dense.value>(
          level, positions.data(), dL_dencoded.data() + std::int64_t{l} * features.value, stride,
          dL_dtable.data() + level.offset * features.value, count);
    });
  }
}

template <class Real>
void HashEncodePositionBackward(const HashGridLayout& layout, std::span<const Real> table,
                                std::span<const Real> positions, std::span<const Real> dL_dencoded,
                                std::int64_t row, std::span<const float> level_weight,
                                std::span<Real> dL_dposition, std::int64_t first,
                                std::int64_t last) {
  for (std::size_t l = 0; l < layout.levels.size(); ++l) {
    const HashGridLevel& level = layout.levels[l];
    if (level_weight[l] == 0) continue;
    Specialize(layout.features, level.dense, [&](auto features, auto dense) {
      PositionBackwardLevel<Real, features.value, dense.value>(
          level, table.data() + level.offset * features.value, positions.data(),
          dL_dencoded.data() + l * features.value, row, static_cast<Real>(level_weight[l]),
          dL_dposition.data(), first, last);
    });
  }
}

#define NERF_INSTANTIATE(Real)                                                                    \
  template void HashEncodeForward(const HashGridLayout&, std::span<const Real>,                   \
                                  std::span<const Real>, std::span<Real>, std::int64_t,           \
                                  std::int64_t);                                                  \
  template void HashEncodeBackward(const HashGridLayout&, std::span<const Real>,                  \
                                   std::span<const Real>, std::span<Real>, int, int);             \
  template void HashEncodePositionBackward(                                                       \
      const HashGridLayout&, std::span<const Real>, std::span<const Real>, std::span<const Real>, \
      std::int64_t, std::span<const float>, std::span<Real>, std::int64_t, std::int64_t);
NERF_INSTANTIATE(float)
NERF_INSTANTIATE(double)
#undef NERF_INSTANTIATE

}  // namespace nerf::kernels
