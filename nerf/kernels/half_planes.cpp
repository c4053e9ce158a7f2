#include "nerf/kernels/half_planes.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/half_planes.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void PlanesImpl(std::span<const std::uint16_t> pixels, const std::array<float, 4>& scale,
                const std::array<float*, 4>& planes) {
  constexpr std::size_t kAtOnce = 16;  // pixels
  const hn::CappedTag<float, kAtOnce> d;
  const hn::Rebind<hwy::float16_t, decltype(d)> of_halves;
  const hn::Rebind<std::uint16_t, decltype(d)> of_bits;
  const std::size_t lanes = hn::Lanes(d), count = pixels.size() / 4;
  alignas(64) std::uint16_t bits[4 * kAtOnce] = {};
  alignas(64) float values[4 * kAtOnce], plane[4][kAtOnce];
  for (std::size_t first = 0; first < count; first += kAtOnce) {
    const std::size_t valid = std::min(kAtOnce, count - first);
    std::copy_n(&pixels[4 * first], 4 * valid, bits);
    for (std::size_t i = 0; i < 4 * kAtOnce; i += lanes) {
      const auto half = hn::BitCast(of_halves, hn::Load(of_bits, bits + i));
      hn::Store(hn::PromoteTo(d, half), d, values + i);
    }
    for (std::size_t i = 0; i < kAtOnce; i += lanes) {
      auto r = hn::Zero(d), g = r, b = r, a = r;
      hn::LoadInterleaved4(d, values + 4 * i, r, g, b, a);
      hn::Store(r * hn::Set(d, scale[0]), d, plane[0] + i);
      hn::Store(g * hn::Set(d, scale[1]), d, plane[1] + i);
      hn::Store(b * hn::Set(d, scale[2]), d, plane[2] + i);
      hn::Store(a * hn::Set(d, scale[3]), d, plane[3] + i);
    }
    for (int k = 0; k < 4; ++k) std::copy_n(plane[k], valid, planes[k] + first);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {

HWY_EXPORT(PlanesImpl);

void PlanesOfHalves(std::span<const std::uint16_t> pixels, const std::array<float, 4>& scale,
                    const std::array<float*, 4>& planes) {
  HWY_DYNAMIC_DISPATCH(PlanesImpl)(pixels, scale, planes);
}

}  // namespace nerf::kernels
#endif
