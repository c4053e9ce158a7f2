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

constexpr std::uint32_t kAllBands = kBands == 32 ? ~0u : (1u << kBands) - 1;

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
    const V far = Constant(g.distance), least = Constant(g.least), yy = Constant(g.yy);
    bool any_ended = false;
    for (int h = 0; h < kAcross; ++h) {
      const V dx = centres.x[h] - Constant(g.x);
      const V peak = Constant(g.log2_opacity);
      const V of_x = hn::MulAdd(dx * dx, Constant(g.xx), peak);
      const V linear = dx * Constant(g.xy);
      for (std::uint32_t rest = bands & alive[h]; rest != 0; rest &= rest - 1) {
        const int band = __builtin_ctz(rest);
        const int at = (band * kAcross + h) * kLanes;
        const V dy = centres.y + Constant(static_cast<float>(band * kRowsOfVector) - g.y);
        // Never above the peak: far from the mean of a needle, rounding could bring it there.
        const V log2_alpha = hn::Min(hn::MulAdd(dy, hn::MulAdd(dy, yy, linear), of_x), peak);
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

HWY_INLINE float Sum(V v) { return hn::GetLane(hn::SumOfLanes(D(), v)); }

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
    return {Sum(sum),     Sum(x), Sum(y), Sum(xx), Sum(xy), Sum(yy), {Sum(r), Sum(g), Sum(b)},
            Sum(distance)};
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
  const V peak = Constant(g.log2_opacity);
  const V of_x = hn::MulAdd(dx * dx, Constant(g.xx), peak);
  const V linear = dx * Constant(g.xy), yy = Constant(g.yy);
  V column = hn::Zero(d), column_y = hn::Zero(d);
  for (std::uint32_t rest = bands & pixels.alive[h]; rest != 0; rest &= rest - 1) {
    const int band = __builtin_ctz(rest);
    const int at = (band * kAcross + h) * kLanes;
    const V dy = centres.y + Constant(static_cast<float>(band * kRowsOfVector) - g.y);
    // Never above the peak: far from the mean of a needle, rounding could bring it there.
    const V log2_alpha = hn::Min(hn::MulAdd(dy, hn::MulAdd(dy, yy, linear), of_x), peak);
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
    column = column + by_log;
    column_y = column_y + by_log_y;
    sums.yy = hn::MulAdd(by_log_y, dy, sums.yy);
    const V after = before - weight;
    hn::Store(after, d, pixels.transmittance + at);
    if (hn::AllFalse(d, hn::Gt(after, stop))) pixels.alive[h] &= ~(1u << band);
  }
  sums.AddColumn(column, column_y, dx);
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
