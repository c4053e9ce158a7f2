// Pixels of a tile as vectors, and which of them a Gaussian touches. Included once for each SIMD
// level.
#if defined(NERF_KERNELS_GAUSSIAN_TILE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NERF_KERNELS_GAUSSIAN_TILE_INL_H_
#undef NERF_KERNELS_GAUSSIAN_TILE_INL_H_
#else
#define NERF_KERNELS_GAUSSIAN_TILE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "nerf/kernels/gaussian_blending.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
constexpr int kVectors = kTilePixels / kLanes;  // of a tile
// Vectors beside each other, and rows of pixels in a vector.
constexpr int kAcross = kLanes < kTileWidth ? kTileWidth / kLanes : 1;
constexpr int kRowsOfVector = kLanes > kTileWidth ? kLanes / kTileWidth : 1;
constexpr int kBands = kVectors / kAcross;
static_assert(kBands <= 32);

HWY_INLINE V Constant(float value) { return hn::Set(D(), value); }

// 2^x for x in [-126, 0], relative error 4e-6: a polynomial on [-1/2, 1/2].
HWY_INLINE V Exp2(V x) {
  const D d;
  const hn::RebindToSigned<D> di;
  const V rounded = hn::Round(x), t = x - rounded;
  V p = hn::MulAdd(t, Constant(0.00133335581f), Constant(0.00961812911f));
  p = hn::MulAdd(t, p, Constant(0.0555041087f));
  p = hn::MulAdd(t, p, Constant(0.240226507f));
  p = hn::MulAdd(t, p, Constant(0.693147181f));
  p = hn::MulAdd(t, p, Constant(1.0f));
  const auto exponent = hn::ShiftLeft<23>(hn::ConvertTo(di, rounded));
  return hn::BitCast(d, hn::Add(hn::BitCast(di, p), exponent));
}

// The centres of the pixels of the vectors of a tile, from its corner.
struct PixelCentres {
  V x[kAcross];
  V y;  // of the first band
};

HWY_INLINE PixelCentres CentresOfTile(const Tile& tile) {
  alignas(64) float x[kAcross][kLanes];
  alignas(64) float y[kLanes];
  for (int h = 0; h < kAcross; ++h) {
    for (int l = 0; l < kLanes; ++l) {
      x[h][l] = static_cast<float>(tile.x + (h * kLanes + l) % kTileWidth) + 0.5f;
    }
  }
  for (int l = 0; l < kLanes; ++l) {
    y[l] = static_cast<float>(tile.y + (kAcross > 1 ? 0 : l / kTileWidth)) + 0.5f;
  }
  PixelCentres centres;
  for (int h = 0; h < kAcross; ++h) centres.x[h] = hn::Load(D(), x[h]);
  centres.y = hn::Load(D(), y);
  return centres;
}

// The bands that a Gaussian may touch, a bit for each.
HWY_INLINE std::uint32_t BandsOf(const ProjectedGaussian& g, const Tile& tile) {
  const float centre = g.y - static_cast<float>(tile.y) - 0.5f;
  // Bounded first: a Gaussian may be larger than an int holds.
  const float top = std::clamp(std::ceil(centre - g.radius_y), 0.0f, 1.0f * kTileHeight);
  const float bottom = std::clamp(std::floor(centre + g.radius_y), -1.0f, kTileHeight - 1.0f);
  if (top > bottom) return 0;
  const int first = static_cast<int>(top) / kRowsOfVector;
  const int last = static_cast<int>(bottom) / kRowsOfVector;
  return (~0u << first) & (~0u >> (31 - last));
}

// A Gaussian along a column of vectors.
struct Column {
  HWY_INLINE Column(const ProjectedGaussian& g, V dx)
      : peak(Constant(g.log2_opacity)),
        of_x(hn::MulAdd(dx * dx, Constant(g.xx), peak)),
        linear(dx * Constant(g.xy)),
        yy(Constant(g.yy)) {}
  // Never above the peak: far from the mean of a needle, rounding could bring it there.
  HWY_INLINE V Log2Alpha(V dy) const {
    return hn::Min(hn::MulAdd(dy, hn::MulAdd(dy, yy, linear), of_x), peak);
  }
  V peak, of_x, linear, yy;
};

HWY_INLINE V OffsetY(const ProjectedGaussian& g, const PixelCentres& centres, int band) {
  return centres.y + Constant(static_cast<float>(band * kRowsOfVector) - g.y);
}

constexpr std::uint32_t kAllBands = kBands == 32 ? ~0u : (1u << kBands) - 1;

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();
#endif
