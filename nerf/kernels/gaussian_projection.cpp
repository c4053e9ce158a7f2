#include "nerf/kernels/gaussian_projection.h"

#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/gaussian_projection.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "nerf/kernels/gaussian_footprint-inl.h"
#include "nerf/kernels/gaussian_harmonics-inl.h"
#include "nerf/kernels/gaussian_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kLog2E = 1.4426950408889634f;

// How far a Gaussian reaches before it is cut, opacity exp(-q / 2) < kLeastAlpha, and whether that
// is on the screen.
struct Reach {
  V radius_x, radius_y;
  M on_screen;
};

HWY_INLINE Reach ReachOf(const GaussianCamera& camera, const Footprint& f) {
  const V range =
      Constant(2) * hn::CallLog(D(), hn::Max(f.opacity * Constant(1 / kLeastAlpha), Constant(1)));
  Reach reach;
  reach.radius_x = hn::Sqrt(range * f.c_xx);
  reach.radius_y = hn::Sqrt(range * f.c_yy);
  const auto reaches = [&](V position, V radius, int size) HWY_ATTR {
    const V half = Constant(0.5f);
    return hn::And(hn::Gt(position + radius, half),
                   hn::Lt(position - radius, Constant(static_cast<float>(size)) - half));
  };
  reach.on_screen = hn::And(reaches(f.x, reach.radius_x, camera.width),
                            reaches(f.y, reach.radius_y, camera.height));
  return reach;
}

// Writes those of a vector that are visible; returns how many.
//   first  index of the Gaussian in the first lane
HWY_INLINE std::int64_t WriteVisible(const Footprint& f, const Reach& reach, M visible,
                                     const V (&rgb)[3], std::int64_t first,
                                     ProjectedGaussian* out) {
  const D d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  constexpr int kFields = 13;
  const V scale = Constant(-0.5f * kLog2E) / f.det_filtered;
  const V log2_share = hn::CallLog2(d, hn::Max(f.peak_share, Constant(kTiny)));
  const V values[kFields] = {f.x,
                             f.y,
                             scale * f.c_yy,
                             Constant(-2) * scale * f.c_xy,
                             scale * f.c_xx,
                             hn::CallLog2(d, f.opacity) + log2_share,
                             log2_share + Constant(std::log2(kLeastAlpha)),
                             rgb[0],
                             rgb[1],
                             rgb[2],
                             f.distance,
                             reach.radius_x,
                             reach.radius_y};
  alignas(64) float fields[kFields][kLanes];
  for (int k = 0; k < kFields; ++k) hn::Store(values[k], d, fields[k]);
  alignas(64) float is_visible[kLanes];
  hn::Store(hn::IfThenElseZero(visible, Constant(1)), d, is_visible);
  std::int64_t written = 0;
  for (int l = 0; l < kLanes; ++l) {
    if (is_visible[l] == 0) continue;
    const auto at = [&](int k) { return fields[k][l]; };
    out[written++] = {at(0),  at(1),  at(2),  at(3),
                      at(4),  at(5),  at(6),  {at(7), at(8), at(9)},
                      at(10), at(11), at(12), static_cast<std::uint32_t>(first + l),
                      0,      0};
  }
  return written;
}

std::int64_t ProjectImpl(const GaussianCamera& camera, int order, const float* parameters,
                         std::int64_t first_block, std::int64_t last_block,
                         ProjectedGaussian* out) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  const std::int64_t block_size = std::int64_t{GaussianRows(order)} * kGaussiansInBlock;
  std::int64_t written = 0;
  Footprint f;
  for (std::int64_t block = first_block; block < last_block; ++block) {
    for (int lane = 0; lane < kGaussiansInBlock; lane += kLanes) {
      const float* const p = parameters + block * block_size + lane;
      if (!PlaceMean(camera, p, f)) continue;
      PlaceEllipse(camera, p, f);
      const Reach reach = ReachOf(camera, f);
      const M visible = hn::And(f.visible, reach.on_screen);
      if (hn::AllFalse(D(), visible)) continue;
      V rgb[3];
      ColorOf(HarmonicsAt(camera, order, f.mean.x, f.mean.y, f.mean.z), order,
              p + kGaussiansInBlock * kColorRow, rgb);
      written +=
          WriteVisible(f, reach, visible, rgb, block * kGaussiansInBlock + lane, out + written);
    }
  }
  return written;
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {

HWY_EXPORT(ProjectImpl);

std::int64_t ProjectGaussians(const GaussianCamera& camera, int order,
                              std::span<const float> parameters, std::int64_t first_block,
                              std::int64_t last_block, ProjectedGaussian* out) {
  return HWY_DYNAMIC_DISPATCH(ProjectImpl)(camera, order, parameters.data(), first_block,
                                           last_block, out);
}

}  // namespace nerf::kernels
#endif
