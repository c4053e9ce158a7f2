// Vectors of neighbouring Gaussians. Included once for each SIMD level.
#if defined(NERF_KERNELS_GAUSSIAN_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NERF_KERNELS_GAUSSIAN_VECTORS_INL_H_
#undef NERF_KERNELS_GAUSSIAN_VECTORS_INL_H_
#else
#define NERF_KERNELS_GAUSSIAN_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include "nerf/kernels/gaussians.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kGaussiansInBlock>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr float kTiny = 1e-30f;

HWY_INLINE V Constant(float value) { return hn::Set(D(), value); }

struct Vector3 {
  V x, y, z;
};
HWY_INLINE Vector3 Add(const Vector3& a, const Vector3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Vector3 Scaled(const Vector3& a, V s) { return {a.x * s, a.y * s, a.z * s}; }
HWY_INLINE V Dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE Vector3 Cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// Times the camera's rotation, and times its inverse.
HWY_INLINE Vector3 Rotated(const GaussianCamera& camera, const Vector3& a) {
  const auto row = [&](int i) HWY_ATTR {
    const float* const r = &camera.rotation[3 * i];
    return Constant(r[0]) * a.x + Constant(r[1]) * a.y + Constant(r[2]) * a.z;
  };
  return {row(0), row(1), row(2)};
}
HWY_INLINE Vector3 RotatedBack(const GaussianCamera& camera, const Vector3& a) {
  const auto column = [&](int i) HWY_ATTR {
    const auto& r = camera.rotation;
    return Constant(r[i]) * a.x + Constant(r[3 + i]) * a.y + Constant(r[6 + i]) * a.z;
  };
  return {column(0), column(1), column(2)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();
#endif
