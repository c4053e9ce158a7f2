#include "nerf/kernels/gaussian_surface.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/gaussian_surface.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "nerf/kernels/gaussian_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {

void SurfaceImpl(const ProjectedGaussian* gaussians, const std::array<float, 3>* normals,
                 const Tile& tile, TileSurface& surface) {
  const D d;
  const V half = Constant(0.5f), stop = Constant(kStopTransmittance);
  alignas(64) float transmittance[kTilePixels];
  std::fill_n(transmittance, kTilePixels, 1.0f);
  surface = {};
  const PixelCentres centres = CentresOfTile(tile);
  std::uint32_t alive[kAcross];
  std::fill_n(alive, kAcross, kAllBands);
  for (const TileEntry& entry : tile.entries) {
    const ProjectedGaussian& g = gaussians[entry.gaussian];
    const std::array<float, 3>& normal = normals[entry.gaussian];
    const V distance = Constant(g.distance), least = Constant(g.least);
    for (int h = 0; h < kAcross; ++h) {
      const Column column(g, centres.x[h] - Constant(g.x));
      for (std::uint32_t rest = BandsOf(g, tile) & alive[h]; rest != 0; rest &= rest - 1) {
        const int band = __builtin_ctz(rest);
        const int at = (band * kAcross + h) * kLanes;
        const V log2_alpha = column.Log2Alpha(OffsetY(g, centres, band));
        const V alpha = hn::IfThenElseZero(hn::Gt(log2_alpha, least), Exp2(log2_alpha));
        const V before = hn::Load(d, transmittance + at), weight = alpha * before;
        const V after = before - weight;
        for (int k = 0; k < 3; ++k) {
          float* const sum = surface.normal[k].data() + at;
          hn::Store(hn::MulAdd(weight, Constant(normal[k]), hn::Load(d, sum)), d, sum);
        }
        const auto is_median = hn::And(hn::Ge(before, half), hn::Lt(after, half));
        float* const median = surface.median_distance.data() + at;
        hn::Store(hn::IfThenElse(is_median, distance, hn::Load(d, median)), d, median);
        hn::Store(after, d, transmittance + at);
        if (hn::AllFalse(d, hn::Gt(after, stop))) alive[h] &= ~(1u << band);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {

HWY_EXPORT(SurfaceImpl);

void FindTileSurface(std::span<const ProjectedGaussian> gaussians,
                     std::span<const std::array<float, 3>> normals, const Tile& tile,
                     TileSurface& surface) {
  HWY_DYNAMIC_DISPATCH(SurfaceImpl)(gaussians.data(), normals.data(), tile, surface);
}

}  // namespace nerf::kernels
#endif
