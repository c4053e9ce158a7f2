// What a camera sees of a block of Gaussians. Included once for each SIMD level.
#if defined(NERF_KERNELS_GAUSSIAN_FOOTPRINT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NERF_KERNELS_GAUSSIAN_FOOTPRINT_INL_H_
#undef NERF_KERNELS_GAUSSIAN_FOOTPRINT_INL_H_
#else
#define NERF_KERNELS_GAUSSIAN_FOOTPRINT_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "nerf/kernels/gaussian_ideal-inl.h"
#include "nerf/kernels/gaussian_lens-inl.h"
#include "nerf/kernels/gaussian_vectors-inl.h"
#include "nerf/kernels/gaussians.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {

constexpr float kLeastLogScale = -20, kMostLogScale = 8;

struct Footprint {
  Vector3 mean, p;
  V distance, opacity, peak_share;  // opacity' / opacity
  Ideal ideal;
  LensAt lens;
  V x, y;            // pixels
  Vector3 j_x, j_y;  // rows of J, of pixels by p
  Vector3 scale;
  M bounded_x, bounded_y, bounded_z;  // scales within their bounds
  V qw, qx, qy, qz, inverse_length;
  Vector3 g[3], axes[3];     // columns of the Gaussian's rotation; of it in the camera, scaled
  Vector3 a_x, a_y, normal;  // rows of J times `axes`; their cross product
  V c_xx, c_xy, c_yy, det, det_filtered;
  M visible;
};

HWY_INLINE V ScaleOf(const float* row, M& bounded) {
  const V log_scale = hn::LoadU(D(), row);
  const V least = Constant(kLeastLogScale), most = Constant(kMostLogScale);
  bounded = hn::And(hn::Ge(log_scale, least), hn::Le(log_scale, most));
  return hn::CallExp(D(), hn::Min(hn::Max(log_scale, least), most));
}

// The columns of the rotation of a quaternion of any length.
HWY_INLINE void RotationOf(const float* rows, Footprint& f) {
  const D d;
  const V w = hn::LoadU(d, rows), x = hn::LoadU(d, rows + 16), y = hn::LoadU(d, rows + 32),
          z = hn::LoadU(d, rows + 48);
  // Divided by the largest first: its square may be too large or too small for float.
  const V largest = hn::Max(hn::Max(hn::Abs(w), hn::Abs(x)), hn::Max(hn::Abs(y), hn::Abs(z)));
  const M is_zero = hn::Lt(largest, Constant(1e-36f));
  const V shrink = Constant(1) / hn::IfThenElse(is_zero, Constant(1), largest);
  const V sw = hn::IfThenElse(is_zero, Constant(1), w * shrink), sx = x * shrink, sy = y * shrink,
          sz = z * shrink;
  const V inverse = Constant(1) / hn::Sqrt(sw * sw + sx * sx + sy * sy + sz * sz);
  f.inverse_length = hn::IfThenElse(is_zero, hn::Zero(d), inverse * shrink);
  f.qw = sw * inverse;
  f.qx = sx * inverse;
  f.qy = sy * inverse;
  f.qz = sz * inverse;
  const V one = Constant(1), two = Constant(2);
  const V xx = f.qx * f.qx, yy = f.qy * f.qy, zz = f.qz * f.qz, xy = f.qx * f.qy, xz = f.qx * f.qz,
          yz = f.qy * f.qz, wx = f.qw * f.qx, wy = f.qw * f.qy, wz = f.qw * f.qz;
  f.g[0] = {one - two * (yy + zz), two * (xy + wz), two * (xz - wy)};
  f.g[1] = {two * (xy - wz), one - two * (xx + zz), two * (yz + wx)};
  f.g[2] = {two * (xz + wy), two * (yz - wx), one - two * (xx + yy)};
}

// The mean in the camera, and whether any of the vector is in front of it.
HWY_INLINE bool PlaceMean(const GaussianCamera& camera, const float* block, Footprint& f) {
  const D d;
  f.mean = {hn::LoadU(d, block), hn::LoadU(d, block + 16), hn::LoadU(d, block + 32)};
  const auto& t = camera.translation;
  f.p = Add(Rotated(camera, f.mean), {Constant(t[0]), Constant(t[1]), Constant(t[2])});
  f.distance = hn::Sqrt(Dot(f.p, f.p));
  f.visible = hn::Gt(camera.is_fisheye ? f.distance : f.p.z, Constant(camera.near));
  return !hn::AllFalse(d, f.visible);
}

HWY_INLINE void PlaceEllipse(const GaussianCamera& camera, const float* block, Footprint& f) {
  const D d;
  const V zero = hn::Zero(d), variance = Constant(kPixelVariance);
  if (camera.is_fisheye) {
    IdealOfFisheye(f.p, f.ideal);
    const V most = Constant(camera.most_ideal[0]);
    f.visible =
        hn::And(f.visible, hn::Lt(f.ideal.u * f.ideal.u + f.ideal.v * f.ideal.v, most * most));
  } else {
    IdealOfPerspective(camera, f.p, f.ideal);
  }
  const Ideal& ideal = f.ideal;
  EvaluateLens(camera, ideal.clamped_u, ideal.clamped_v, f.lens);
  const LensAt& lens = f.lens;
  const V fx = Constant(camera.fx), fy = Constant(camera.fy);
  const V du = ideal.u - ideal.clamped_u, dv = ideal.v - ideal.clamped_v;
  f.x = fx * (lens.x + lens.x_u * du + lens.x_v * dv) + Constant(camera.cx);
  f.y = fy * (lens.y + lens.y_u * du + lens.y_v * dv) + Constant(camera.cy);
  f.j_x = Add(Scaled(ideal.u_p, fx * lens.x_u), Scaled(ideal.v_p, fx * lens.x_v));
  f.j_y = Add(Scaled(ideal.u_p, fy * lens.y_u), Scaled(ideal.v_p, fy * lens.y_v));

  f.scale = {ScaleOf(block + 16 * kLogScaleRow, f.bounded_x),
             ScaleOf(block + 16 * (kLogScaleRow + 1), f.bounded_y),
             ScaleOf(block + 16 * (kLogScaleRow + 2), f.bounded_z)};
  RotationOf(block + 16 * kRotationRow, f);
  f.axes[0] = Scaled(Rotated(camera, f.g[0]), f.scale.x);
  f.axes[1] = Scaled(Rotated(camera, f.g[1]), f.scale.y);
  f.axes[2] = Scaled(Rotated(camera, f.g[2]), f.scale.z);
  f.a_x = {Dot(f.j_x, f.axes[0]), Dot(f.j_x, f.axes[1]), Dot(f.j_x, f.axes[2])};
  f.a_y = {Dot(f.j_y, f.axes[0]), Dot(f.j_y, f.axes[1]), Dot(f.j_y, f.axes[2])};
  f.normal = Cross(f.a_x, f.a_y);
  f.det = Dot(f.normal, f.normal);
  const V sum_xx = Dot(f.a_x, f.a_x), sum_yy = Dot(f.a_y, f.a_y);
  f.c_xx = sum_xx + variance;
  f.c_xy = Dot(f.a_x, f.a_y);
  f.c_yy = sum_yy + variance;
  f.det_filtered = f.det + variance * (sum_xx + sum_yy + variance);
  f.peak_share = hn::Sqrt(f.det / f.det_filtered);
  const V logit = hn::LoadU(d, block + 16 * kOpacityRow);
  f.opacity = Constant(kMostOpacity) /
              (Constant(1) + hn::CallExp(d, hn::Neg(hn::Max(logit, Constant(-80)))));
  f.visible = hn::And(
      f.visible, hn::And(hn::Gt(f.opacity, Constant(kLeastAlpha)), hn::Gt(f.peak_share, zero)));
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();
#endif
