#include "nerf/kernels/hash_encoding_tile.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/hash_encoding_tile.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Samples whose cells are computed at once. Their entries and weights stay in the first-level
// cache, and the loads of one sample's entries overlap with the arithmetic of the next.
constexpr std::int64_t kBlock = 64;

struct Cells {
  alignas(64) std::uint32_t entry[8][kBlock];
  alignas(64) float weight[8][kBlock];
};

// Computes the cells of `count` samples, at most kBlock. Writes whole vectors.
template <bool kDense>
HWY_INLINE void FindCells(const HashGridLevel& level, const float* positions, std::int64_t count,
                          Cells& cells) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::RebindToUnsigned<decltype(d)> du;
  using VU = hn::Vec<decltype(du)>;
  using VF = hn::Vec<decltype(d)>;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  const VF resolution = hn::Set(d, static_cast<float>(level.resolution));
  const auto last_cell = hn::Set(di, static_cast<std::int32_t>(level.resolution) - 1);
  const std::uint32_t side = level.resolution + 1;
  const VU stride_y = hn::Set(du, kDense ? side : kHashPrimeY);
  const VU stride_z = hn::Set(du, kDense ? side * side : kHashPrimeZ);
  const VU mask = hn::Set(du, level.size - 1);
  const VU one = hn::Set(du, 1u);
  const VF one_f = hn::Set(d, 1.0f);

  for (std::int64_t i = 0; i < count; i += lanes) {
    VF scaled[3];
    if (i + lanes <= count) {
      hn::LoadInterleaved3(d, positions + 3 * i, scaled[0], scaled[1], scaled[2]);
    } else {
      alignas(64) float rest[3 * 16] = {};
      std::copy(positions + 3 * i, positions + 3 * count, rest);
      hn::LoadInterleaved3(d, rest, scaled[0], scaled[1], scaled[2]);
    }
    VU corner[3];
    VF w[3][2];
    for (int axis = 0; axis < 3; ++axis) {
      scaled[axis] = hn::Mul(scaled[axis], resolution);
      // Positions are not negative, so truncation rounds down. The far face belongs to the last
      // cell.
      const auto cell = hn::Min(hn::ConvertTo(di, scaled[axis]), last_cell);
      corner[axis] = hn::BitCast(du, cell);
      w[axis][1] = hn::Sub(scaled[axis], hn::ConvertTo(d, cell));
      w[axis][0] = hn::Sub(one_f, w[axis][1]);
    }
    const VU x[2] = {corner[0], hn::Add(corner[0], one)};
    const VU y0 = hn::Mul(corner[1], stride_y), z0 = hn::Mul(corner[2], stride_z);
    const VU y[2] = {y0, hn::Add(y0, stride_y)};
    const VU z[2] = {z0, hn::Add(z0, stride_z)};
    for (int k = 0; k < 8; ++k) {
      const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
      const VU entry = kDense ? hn::Add(x[dx], hn::Add(y[dy], z[dz]))
                              : hn::And(hn::Xor(x[dx], hn::Xor(y[dy], z[dz])), mask);
      hn::Store(entry, du, &cells.entry[k][i]);
      hn::Store(hn::Mul(w[0][dx], hn::Mul(w[1][dy], w[2][dz])), d, &cells.weight[k][i]);
    }
  }
}

HWY_INLINE void FindCells(const HashGridLevel& level, const float* positions, std::int64_t count,
                          Cells& cells) {
  level.dense ? FindCells<true>(level, positions, count, cells)
              : FindCells<false>(level, positions, count, cells);
}

// The features of an entry as vectors of at most 4 lanes, the shortest vector length.
template <int kFeatures>
struct Entry {
  static constexpr int kMostLanes = HWY_TARGET == HWY_SCALAR ? 1 : 4;
  static constexpr int kLanes = kFeatures < kMostLanes ? kFeatures : kMostLanes;
  static constexpr int kVectors = kFeatures / kLanes;
  hn::FixedTag<float, kLanes> d;
};

template <int kFeatures>
void EncodeLevel(const HashGridLevel& level, const float* table, const float* positions,
                 std::int64_t count, float level_weight, float* encoded, std::int64_t row) {
  using E = Entry<kFeatures>;
  const auto d = E().d;
  const auto scale = hn::Set(d, level_weight);
  Cells cells;
  FindCells(level, positions, count, cells);
  for (std::int64_t i = 0; i < count; ++i) {
    for (int v = 0; v < E::kVectors; ++v) {
      auto sum = hn::Zero(d);
      for (int k = 0; k < 8; ++k) {
        const float* entry = table + static_cast<std::int64_t>(cells.entry[k][i]) * kFeatures;
        sum = hn::MulAdd(hn::Set(d, cells.weight[k][i]), hn::LoadU(d, entry + v * E::kLanes), sum);
      }
      hn::StoreU(hn::Mul(scale, sum), d, encoded + i * row + v * E::kLanes);
    }
  }
}

template <int kFeatures>
void ScatterLevel(const HashGridLevel& level, const float* positions, const float* dL_dencoded,
                  std::int64_t row, std::int64_t count, float level_weight, float* dL_dtable) {
  using E = Entry<kFeatures>;
  const auto d = E().d;
  const auto scale = hn::Set(d, level_weight);
  Cells cells;
  FindCells(level, positions, count, cells);
  for (std::int64_t i = 0; i < count; ++i) {
    for (int v = 0; v < E::kVectors; ++v) {
      const auto g = hn::Mul(scale, hn::LoadU(d, dL_dencoded + i * row + v * E::kLanes));
      for (int k = 0; k < 8; ++k) {
        float* entry =
            dL_dtable + static_cast<std::int64_t>(cells.entry[k][i]) * kFeatures + v * E::kLanes;
        hn::StoreU(hn::MulAdd(hn::Set(d, cells.weight[k][i]), g, hn::LoadU(d, entry)), d, entry);
      }
    }
  }
}

void EncodeImpl(const HashGridLayout& layout, const float* table, const float* positions,
                std::int64_t count, const float* level_weight, float* encoded, std::int64_t row) {
  const int features = layout.features;
  const auto encode_level = features == 1   ? EncodeLevel<1>
                            : features == 2 ? EncodeLevel<2>
                            : features == 4 ? EncodeLevel<4>
                                            : EncodeLevel<8>;
  // Levels are the outer loop, so that the table of a level and the rows of the tile stay in the
  // cache.
  for (std::size_t l = 0; l < layout.levels.size(); ++l) {
    float* const out = encoded + l * features;
    if (level_weight[l] == 0) {
      for (std::int64_t i = 0; i < count; ++i) std::fill_n(out + i * row, features, 0.0f);
      continue;
    }
    const float* const entries = table + layout.levels[l].offset * features;
    for (std::int64_t first = 0; first < count; first += kBlock) {
      encode_level(layout.levels[l], entries, positions + 3 * first,
                   std::min(kBlock, count - first), level_weight[l], out + first * row, row);
    }
  }
}

void ScatterImpl(const HashGridLayout& layout, int l, float level_weight, const float* positions,
                 const float* dL_dencoded, std::int64_t row, std::int64_t count, float* dL_dtable) {
  const int features = layout.features;
  const auto scatter_level = features == 1   ? ScatterLevel<1>
                             : features == 2 ? ScatterLevel<2>
                             : features == 4 ? ScatterLevel<4>
                                             : ScatterLevel<8>;
  const HashGridLevel& level = layout.levels[l];
  for (std::int64_t first = 0; first < count; first += kBlock) {
    scatter_level(level, positions + 3 * first, dL_dencoded + first * row + l * features, row,
                  std::min(kBlock, count - first), level_weight,
                  dL_dtable + level.offset * features);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {
HWY_EXPORT(EncodeImpl);
HWY_EXPORT(ScatterImpl);

void HashEncodeTile(const HashGridLayout& layout, const float* table, const float* positions,
                    std::int64_t count, std::span<const float> level_weight, float* encoded,
                    std::int64_t row) {
  HWY_DYNAMIC_DISPATCH(EncodeImpl)
  (layout, table, positions, count, level_weight.data(), encoded, row);
}

void HashScatterLevel(const HashGridLayout& layout, int level, float level_weight,
                      const float* positions, const float* dL_dencoded, std::int64_t row,
                      std::int64_t count, float* dL_dtable) {
  if (level_weight == 0) return;
  HWY_DYNAMIC_DISPATCH(ScatterImpl)
  (layout, level, level_weight, positions, dL_dencoded, row, count, dL_dtable);
}
}  // namespace nerf::kernels
#endif
