#include "nerf/kernels/gaussian_blending.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/gaussian_blending.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "nerf/kernels/gaussian_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

std::int64_t ForwardImpl(const ProjectedGaussian* gaussians, const Tile& tile,
                         TilePicture& picture) {
  const D d;
  const V zero = hn::Zero(d), stop = Constant(kStopTransmittance);
  float* const red = picture.rgb[0].data();
  float* const green = picture.rgb[1].data();
  float* const blue = picture.rgb[2].data();
  float* const transmittance = picture.transmittance.data();
  float* const distance = picture.distance.data();
  for (int v = 0; v < kTilePixels; v += kLanes) {
    for (float* const channel : {red, green, blue, distance}) hn::Store(zero, d, channel + v);
    hn::Store(Constant(1), d, transmittance + v);
  }
  const PixelCentres centres = CentresOfTile(tile);
  std::uint32_t alive[kAcross];
  std::fill_n(alive, kAcross, kAllBands);
  const std::size_t count = tile.entries.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (k + 6 < count) hwy::Prefetch(&gaussians[tile.entries[k + 6].gaussian]);
    const ProjectedGaussian& g = gaussians[tile.entries[k].gaussian];
    const std::uint32_t bands = BandsOf(g, tile);
    const V r = Constant(g.rgb[0]), gr = Constant(g.rgb[1]), b = Constant(g.rgb[2]);
    const V far = Constant(g.distance), least = Constant(g.least);
    bool any_ended = false;
    for (int h = 0; h < kAcross; ++h) {
      const Column column(g, centres.x[h] - Constant(g.x));
      for (std::uint32_t rest = bands & alive[h]; rest != 0; rest &= rest - 1) {
        const int band = __builtin_ctz(rest);
        const int at = (band * kAcross + h) * kLanes;
        const V log2_alpha = column.Log2Alpha(OffsetY(g, centres, band));
        const V alpha = hn::IfThenElseZero(hn::Gt(log2_alpha, least), Exp2(log2_alpha));
        const V before = hn::Load(d, transmittance + at);
        const V weight = alpha * before;
        hn::Store(hn::MulAdd(weight, r, hn::Load(d, red + at)), d, red + at);
        hn::Store(hn::MulAdd(weight, gr, hn::Load(d, green + at)), d, green + at);
        hn::Store(hn::MulAdd(weight, b, hn::Load(d, blue + at)), d, blue + at);
        hn::Store(hn::MulAdd(weight, far, hn::Load(d, distance + at)), d, distance + at);
        const V after = before - weight;
        hn::Store(after, d, transmittance + at);
        if (hn::AllFalse(d, hn::Gt(after, stop))) {
          alive[h] &= ~(1u << band);
          any_ended = true;
        }
      }
    }
    if (any_ended) {
      std::uint32_t any = 0;
      for (const std::uint32_t of_column : alive) any |= of_column;
      if (any == 0) return static_cast<std::int64_t>(k + 1);
    }
  }
  return static_cast<std::int64_t>(count);
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE void StoreSums(V a, V b, V c, V e, float* sums) {
  for (const V v : {a, b, c, e}) *sums++ = hn::GetLane(v);
}

#else

// The sum of the 128-bit blocks of a vector.
template <class DV, class Vec>
HWY_INLINE auto SumOfBlocks([[maybe_unused]] DV d, Vec v) {
  if constexpr (hn::MaxLanes(DV()) > 4) {
    const hn::Half<DV> half;
    return SumOfBlocks(half, hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
  } else {
    return v;
  }
}

// Writes the sums over the lanes of four vectors at once, which takes half the instructions of one
// after another.
HWY_INLINE void StoreSums(V a, V b, V c, V e, float* sums) {
  const D d;
  const hn::Repartition<std::uint64_t, D> pairs;
  // In each block: a0+a2, b0+b2, a1+a3, b1+b3.
  const V ab = hn::InterleaveLower(d, a, b) + hn::InterleaveUpper(d, a, b);
  const V ce = hn::InterleaveLower(d, c, e) + hn::InterleaveUpper(d, c, e);
  const auto ab_pairs = hn::BitCast(pairs, ab), ce_pairs = hn::BitCast(pairs, ce);
  const V abce = hn::BitCast(d, hn::InterleaveLower(pairs, ab_pairs, ce_pairs)) +
                 hn::BitCast(d, hn::InterleaveUpper(pairs, ab_pairs, ce_pairs));
  hn::Store(SumOfBlocks(d, abce), hn::Full128<float>(), sums);
}

#endif

HWY_INLINE V LoadAt(const std::array<float, kTilePixels>& values, int at) {
  return hn::Load(D(), values.data() + at);
}

// Sums over the pixels of a tile for one Gaussian, lane by lane.
struct MomentSums {
  MomentSums() : sum(hn::Zero(D())) { x = y = xx = xy = yy = r = g = b = distance = sum; }

  // What all rows of a column of vectors have in common is added once.
  //   of_column    dL/d(ln alpha)    of_column_y  times dy
  HWY_INLINE void AddColumn(V of_column, V of_column_y, V dx) {
    const V of_column_x = of_column * dx;
    sum = sum + of_column;
    x = x + of_column_x;
    y = y + of_column_y;
    xx = hn::MulAdd(of_column_x, dx, xx);
    xy = hn::MulAdd(of_column_y, dx, xy);
  }
  HWY_INLINE GaussianMoments Total() const {
    alignas(16) float s[12];
    StoreSums(sum, x, y, xx, s);
    StoreSums(xy, yy, r, g, s + 4);
    StoreSums(b, distance, b, distance, s + 8);
    return {s[0], s[1], s[2], s[3], s[4], s[5], {s[6], s[7], s[8]}, s[9]};
  }

  V sum, x, y, xx, xy, yy, r, g, b, distance;
};

// The pixels of a tile in the backward pass.
struct BackwardPixels {
  BackwardPixels(const TilePicture& picture, const TilePicture& dL) {
    const D d;
    for (int at = 0; at < kTilePixels; at += kLanes) {
      hn::Store(Constant(1), d, transmittance + at);
      V all = LoadAt(dL.transmittance, at) * LoadAt(picture.transmittance, at) +
              LoadAt(dL.distance, at) * LoadAt(picture.distance, at);
      for (int c = 0; c < 3; ++c) {
        all = hn::MulAdd(LoadAt(dL.rgb[c], at), LoadAt(picture.rgb[c], at), all);
      }
      hn::Store(all, d, behind + at);
    }
    std::fill_n(alive, kAcross, kAllBands);
  }

  alignas(64) float transmittance[kTilePixels];
  alignas(64) float behind[kTilePixels];  // what is behind, times its gradients
  std::uint32_t alive[kAcross];
};

// One Gaussian in one column of vectors.
HWY_INLINE void BackwardColumn(const ProjectedGaussian& g, const PixelCentres& centres, int h,
                               std::uint32_t bands, const TilePicture& dL, BackwardPixels& pixels,
                               MomentSums& sums) {
  const D d;
  const V one = Constant(1), stop = Constant(kStopTransmittance), least = Constant(g.least);
  const V red = Constant(g.rgb[0]), green = Constant(g.rgb[1]), blue = Constant(g.rgb[2]);
  const V far = Constant(g.distance), dx = centres.x[h] - Constant(g.x);
  const Column column(g, dx);
  V sum = hn::Zero(d), sum_y = hn::Zero(d);
  for (std::uint32_t rest = bands & pixels.alive[h]; rest != 0; rest &= rest - 1) {
    const int band = __builtin_ctz(rest);
    const int at = (band * kAcross + h) * kLanes;
    const V dy = OffsetY(g, centres, band), log2_alpha = column.Log2Alpha(dy);
    const auto counts = hn::Gt(log2_alpha, least);
    if (hn::AllFalse(d, counts)) continue;
    const V alpha = hn::IfThenElseZero(counts, Exp2(log2_alpha));
    const V before = hn::Load(d, pixels.transmittance + at), weight = alpha * before;
    const V g_r = LoadAt(dL.rgb[0], at), g_g = LoadAt(dL.rgb[1], at), g_b = LoadAt(dL.rgb[2], at);
    const V g_far = LoadAt(dL.distance, at);
    // dL/dweight, were it not for what is behind.
    const V value =
        hn::MulAdd(g_r, red, hn::MulAdd(g_g, green, hn::MulAdd(g_b, blue, g_far * far)));
    const V behind = hn::NegMulAdd(weight, value, hn::Load(d, pixels.behind + at));
    hn::Store(behind, d, pixels.behind + at);
    const V by_log = alpha * (before * value - behind / (one - alpha)), by_log_y = by_log * dy;
    sums.r = hn::MulAdd(weight, g_r, sums.r);
    sums.g = hn::MulAdd(weight, g_g, sums.g);
    sums.b = hn::MulAdd(weight, g_b, sums.b);
    sums.distance = hn::MulAdd(weight, g_far, sums.distance);
    sum = sum + by_log;
    sum_y = sum_y + by_log_y;
    sums.yy = hn::MulAdd(by_log_y, dy, sums.yy);
    const V after = before - weight;
    hn::Store(after, d, pixels.transmittance + at);
    if (hn::AllFalse(d, hn::Gt(after, stop))) pixels.alive[h] &= ~(1u << band);
  }
  sums.AddColumn(sum, sum_y, dx);
}

void BackwardImpl(const ProjectedGaussian* gaussians, const Tile& tile, const TilePicture& picture,
                  const TilePicture& dL, GaussianMoments* moments) {
  BackwardPixels pixels(picture, dL);
  const PixelCentres centres = CentresOfTile(tile);
  const std::size_t count = tile.entries.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (k + 4 < count) hwy::Prefetch(&gaussians[tile.entries[k + 4].gaussian]);
    const ProjectedGaussian& g = gaussians[tile.entries[k].gaussian];
    const std::uint32_t bands = BandsOf(g, tile);
    MomentSums sums;
    for (int h = 0; h < kAcross; ++h) BackwardColumn(g, centres, h, bands, dL, pixels, sums);
    moments[tile.entries[k].slot] = sums.Total();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {

HWY_EXPORT(ForwardImpl);
HWY_EXPORT(BackwardImpl);

std::int64_t BlendTile(std::span<const ProjectedGaussian> gaussians, const Tile& tile,
                       TilePicture& picture) {
  return HWY_DYNAMIC_DISPATCH(ForwardImpl)(gaussians.data(), tile, picture);
}

void BlendTileBackward(std::span<const ProjectedGaussian> gaussians, const Tile& tile,
                       const TilePicture& picture, const TilePicture& dL_dpicture,
                       std::span<GaussianMoments> moments) {
  HWY_DYNAMIC_DISPATCH(BackwardImpl)(gaussians.data(), tile, picture, dL_dpicture, moments.data());
}

}  // namespace nerf::kernels
#endif
