#include "nerf/kernels/gaussian_projection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/gaussian_projection.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "nerf/kernels/gaussian_harmonics-inl.h"
#include "nerf/kernels/gaussian_lens-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kGaussiansInBlock>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr float kLog2E = 1.4426950408889634f;
constexpr float kLeastLogScale = -20, kMostLogScale = 8;
constexpr float kTiny = 1e-30f;
// Closer to the axis of a fisheye than this tangent, series replace differences of equal numbers.
constexpr float kNearAxis = 0.25f;

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

// --- From the camera to the ideal plane of its lens ------------------------------------------

// The ideal point (u, v) of a point p in the camera, and its Jacobian.
struct Ideal {
  V u, v;
  Vector3 u_p, v_p;
  V clamped_u, clamped_v;  // to most_ideal; there the Jacobian is taken
  M inside_u, inside_v;    // not clamped
  // Of fisheyes: see IdealOfFisheye.
  V e_x, e_y, q, w, t, radius, inverse_square;
};

// (x / z, y / z).
HWY_INLINE void IdealOfPerspective(const GaussianCamera& camera, const Vector3& p, Ideal& ideal) {
  const V inverse_z = Constant(1) / hn::Max(p.z, Constant(camera.near));
  ideal.u = p.x * inverse_z;
  ideal.v = p.y * inverse_z;
  const V most_u = Constant(camera.most_ideal[0]), most_v = Constant(camera.most_ideal[1]);
  ideal.inside_u = hn::Le(hn::Abs(ideal.u), most_u);
  ideal.inside_v = hn::Le(hn::Abs(ideal.v), most_v);
  ideal.clamped_u = hn::Min(hn::Max(ideal.u, hn::Neg(most_u)), most_u);
  ideal.clamped_v = hn::Min(hn::Max(ideal.v, hn::Neg(most_v)), most_v);
  const V zero = hn::Zero(D());
  ideal.u_p = {inverse_z, zero, hn::Neg(ideal.clamped_u * inverse_z)};
  ideal.v_p = {zero, inverse_z, hn::Neg(ideal.clamped_v * inverse_z)};
}

// theta e with the angle theta to the axis and e = (x, y) / r: with q = theta / r, d^2 = |p|^2,
// w = z / d^2 and t = r / d^2 the Jacobian is (q (I - e e^T) + w e e^T | -t e).
HWY_INLINE void IdealOfFisheye(const Vector3& p, Ideal& ideal) {
  const D d;
  const V one = Constant(1), zero = hn::Zero(d);
  const V r2 = p.x * p.x + p.y * p.y, d2 = hn::Max(r2 + p.z * p.z, Constant(kTiny));
  const V r = hn::Sqrt(r2);
  const V inverse_r = one / hn::Max(r, Constant(kTiny));
  ideal.radius = r;
  ideal.inverse_square = one / d2;
  ideal.e_x = hn::IfThenElse(hn::Gt(r, Constant(kTiny)), p.x * inverse_r, one);
  ideal.e_y = hn::IfThenElse(hn::Gt(r, Constant(kTiny)), p.y * inverse_r, zero);
  // atan of a ratio below 1, completed to the angle.
  const V z_abs = hn::Abs(p.z);
  const M wide = hn::Gt(r, z_abs);
  const V ratio = hn::Min(r, z_abs) / hn::Max(hn::Max(r, z_abs), Constant(kTiny));
  const V part = hn::CallAtan(d, ratio);
  V theta = hn::IfThenElse(wide, Constant(1.5707963267948966f) - part, part);
  theta = hn::IfThenElse(hn::Lt(p.z, zero), Constant(3.141592653589793f) - theta, theta);
  ideal.q = hn::IfThenElse(hn::Gt(r, Constant(1e-4f) * p.z), theta * inverse_r,
                           one / hn::Max(p.z, Constant(kTiny)));
  ideal.w = p.z * ideal.inverse_square;
  ideal.t = r * ideal.inverse_square;
  ideal.u = ideal.clamped_u = p.x * ideal.q;
  ideal.v = ideal.clamped_v = p.y * ideal.q;
  ideal.inside_u = ideal.inside_v = hn::Eq(zero, zero);
  const V along = ideal.w - ideal.q;
  const V exy = ideal.e_x * ideal.e_y * along;
  ideal.u_p = {ideal.q + ideal.e_x * ideal.e_x * along, exy, hn::Neg(ideal.t * ideal.e_x)};
  ideal.v_p = {exy, ideal.q + ideal.e_y * ideal.e_y * along, hn::Neg(ideal.t * ideal.e_y)};
}

// The gradient by p of the sum of the entries of the Jacobian of a perspective lens, each times its
// weight; what the clamped ideal point does is added to by_u and by_v.
HWY_INLINE Vector3 PerspectiveJacobianGradient(const GaussianCamera& camera, const Vector3& p,
                                               const Ideal& ideal, const Vector3& g_u,
                                               const Vector3& g_v, V& by_u, V& by_v) {
  const V inverse_z = Constant(1) / hn::Max(p.z, Constant(camera.near));
  by_u = by_u - g_u.z * inverse_z;
  by_v = by_v - g_v.z * inverse_z;
  const V zero = hn::Zero(D());
  return {zero, zero, hn::Neg(inverse_z * (Dot(g_u, ideal.u_p) + Dot(g_v, ideal.v_p)))};
}

HWY_INLINE Vector3 FisheyeJacobianGradient(const Vector3& p, const Ideal& ideal, const Vector3& g_u,
                                           const Vector3& g_v) {
  const V two = Constant(2), e_x = ideal.e_x, e_y = ideal.e_y, d2 = ideal.inverse_square;
  const V mixed = g_u.y + g_v.x, trace = g_u.x + g_v.y;
  const V quadratic = e_x * (g_u.x * e_x + mixed * e_y) + e_y * g_v.y * e_y;
  const V linear = g_u.z * e_x + g_v.z * e_y;
  // (w - q) / r, by its series in rho = r / z near the axis.
  const V inverse_z = Constant(1) / hn::Max(hn::Abs(p.z), Constant(kTiny));
  const V rho = ideal.radius * inverse_z, rho2 = rho * rho;
  const V series = rho * inverse_z * inverse_z *
                   (Constant(-2.0f / 3) +
                    rho2 * (Constant(4.0f / 5) +
                            rho2 * (Constant(-6.0f / 7) +
                                    rho2 * (Constant(8.0f / 9) - rho2 * Constant(10.0f / 11)))));
  const M near_axis = hn::And(hn::Gt(p.z, hn::Zero(D())), hn::Lt(rho, Constant(kNearAxis)));
  const V by_radius = hn::IfThenElse(near_axis, series,
                                     (ideal.w - ideal.q) / hn::Max(ideal.radius, Constant(kTiny)));
  // Derivatives by r and z of q, w and t.
  const V q_r = by_radius, q_z = hn::Neg(d2);
  const V w_r = hn::Neg(two * ideal.w * ideal.t);
  const V w_z = ideal.t * ideal.t - ideal.w * ideal.w;
  const V t_r = hn::Neg(w_z), t_z = w_r;
  const V f_r = q_r * (trace - quadratic) + w_r * quadratic - t_r * linear;
  const V f_z = q_z * (trace - quadratic) + w_z * quadratic - t_z * linear;
  // By e, across it, divided by r: t / r is 1 / d^2.
  const V along_e_x = by_radius * (two * g_u.x * e_x + mixed * e_y) - d2 * g_u.z;
  const V along_e_y = by_radius * (two * g_v.y * e_y + mixed * e_x) - d2 * g_v.z;
  const V across = along_e_y * e_x - along_e_x * e_y;
  return {f_r * e_x - across * e_y, f_r * e_y + across * e_x, f_z};
}

// --- The footprint of a block ----------------------------------------------------------------

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

std::int64_t ProjectImpl(const GaussianCamera& camera, int order, const float* parameters,
                         std::int64_t first_block, std::int64_t last_block,
                         ProjectedGaussian* out) {
  const D d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  const std::size_t block_size = static_cast<std::size_t>(GaussianRows(order)) * 16;
  constexpr int kFields = 13;
  alignas(64) float fields[kFields][kLanes];
  std::int64_t written = 0;
  Footprint f;
  for (std::int64_t block = first_block; block < last_block; ++block) {
    for (int lane = 0; lane < kGaussiansInBlock; lane += kLanes) {
      const float* const p = parameters + block * block_size + lane;
      if (!PlaceMean(camera, p, f)) continue;
      PlaceEllipse(camera, p, f);
      // What is cut: opacity exp(-q / 2) < kLeastAlpha.
      const V range =
          Constant(2) * hn::CallLog(d, hn::Max(f.opacity * Constant(1 / kLeastAlpha), Constant(1)));
      const V radius_x = hn::Sqrt(range * f.c_xx), radius_y = hn::Sqrt(range * f.c_yy);
      const V half = Constant(0.5f);
      const M on_screen = hn::And(
          hn::And(hn::Gt(f.x + radius_x, half),
                  hn::Lt(f.x - radius_x, Constant(static_cast<float>(camera.width)) - half)),
          hn::And(hn::Gt(f.y + radius_y, half),
                  hn::Lt(f.y - radius_y, Constant(static_cast<float>(camera.height)) - half)));
      const M visible = hn::And(f.visible, on_screen);
      if (hn::AllFalse(d, visible)) continue;
      const Harmonics harmonics = HarmonicsAt(camera, order, f.mean.x, f.mean.y, f.mean.z);
      V rgb[3];
      ColorOf(harmonics, order, p + 16 * kColorRow, rgb);
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
                                 radius_x,
                                 radius_y};
      for (int k = 0; k < kFields; ++k) hn::Store(values[k], d, fields[k]);
      alignas(64) float is_visible[kLanes];
      hn::Store(hn::IfThenElseZero(visible, Constant(1)), d, is_visible);
      for (int l = 0; l < kLanes; ++l) {
        if (is_visible[l] == 0) continue;
        out[written++] = {fields[0][l],
                          fields[1][l],
                          fields[2][l],
                          fields[3][l],
                          fields[4][l],
                          fields[5][l],
                          fields[6][l],
                          {fields[7][l], fields[8][l], fields[9][l]},
                          fields[10][l],
                          fields[11][l],
                          fields[12][l],
                          static_cast<std::uint32_t>(block * kGaussiansInBlock + lane + l),
                          0,
                          0};
      }
    }
  }
  return written;
}

// --- Backward --------------------------------------------------------------------------------

struct Moments {
  V sum, x, y, xx, xy, yy, rgb[3], distance;
};

HWY_INLINE Moments LoadMoments(const GaussianMoments* moments) {
  const D d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  constexpr int kFields = sizeof(GaussianMoments) / sizeof(float);
  alignas(64) float fields[kFields][kLanes];
  for (int l = 0; l < kLanes; ++l) {
    const auto* const values = reinterpret_cast<const float*>(&moments[l]);
    for (int k = 0; k < kFields; ++k) fields[k][l] = values[k];
  }
  const auto load = [&](int k) HWY_ATTR { return hn::Load(d, fields[k]); };
  return {load(0), load(1), load(2), load(3), load(4), load(5), {load(6), load(7), load(8)},
          load(9)};
}

// The gradients by a_x and a_y, and by the position on the screen.
struct EllipseGradient {
  Vector3 a_x, a_y;
  V x, y;
};

HWY_INLINE EllipseGradient BackThroughEllipse(const Footprint& f, const Moments& m) {
  const V half = Constant(0.5f), two = Constant(2), inverse = Constant(1) / f.det_filtered;
  // Q, the inverse of the filtered covariance.
  const V q_xx = f.c_yy * inverse, q_xy = hn::Neg(f.c_xy * inverse), q_yy = f.c_xx * inverse;
  EllipseGradient g;
  g.x = q_xx * m.x + q_xy * m.y;
  g.y = q_xy * m.x + q_yy * m.y;
  // dL/dSigma' = (Q M Q - sum Q) / 2 with the second moments M.
  const V u_xx = q_xx * m.xx + q_xy * m.xy, u_xy = q_xx * m.xy + q_xy * m.yy;
  const V u_yx = q_xy * m.xx + q_yy * m.xy, u_yy = q_xy * m.xy + q_yy * m.yy;
  const V s_xx = half * (u_xx * q_xx + u_xy * q_xy - m.sum * q_xx);
  const V s_xy = half * (u_xx * q_xy + u_xy * q_yy - m.sum * q_xy);
  const V s_yy = half * (u_yx * q_xy + u_yy * q_yy - m.sum * q_yy);
  // ln opacity' contains ln |a_x x a_y|.
  const Vector3 by_normal = Scaled(f.normal, m.sum / hn::Max(f.det, Constant(kTiny)));
  g.a_x = Add(Scaled(Add(Scaled(f.a_x, s_xx), Scaled(f.a_y, s_xy)), two), Cross(f.a_y, by_normal));
  g.a_y = Add(Scaled(Add(Scaled(f.a_x, s_xy), Scaled(f.a_y, s_yy)), two), Cross(by_normal, f.a_x));
  return g;
}

// The gradient by the point in the camera, of the position and of the Jacobian.
HWY_INLINE Vector3 BackThroughLens(const GaussianCamera& camera, const Footprint& f,
                                   const EllipseGradient& g, const Vector3& by_j_x,
                                   const Vector3& by_j_y) {
  const Ideal& ideal = f.ideal;
  const LensAt& lens = f.lens;
  const V fx = Constant(camera.fx), fy = Constant(camera.fy), zero = hn::Zero(D());
  const Vector3 h_x = Scaled(by_j_x, fx), h_y = Scaled(by_j_y, fy);
  // J = lens Jacobian times ideal Jacobian.
  V by_u, by_v;
  LensJacobianGradient(camera, lens, Dot(h_x, ideal.u_p), Dot(h_x, ideal.v_p), Dot(h_y, ideal.u_p),
                       Dot(h_y, ideal.v_p), by_u, by_v);
  const Vector3 by_u_p = Add(Scaled(h_x, lens.x_u), Scaled(h_y, lens.y_u));
  const Vector3 by_v_p = Add(Scaled(h_x, lens.x_v), Scaled(h_y, lens.y_v));
  Vector3 by_p = camera.is_fisheye
                     ? FisheyeJacobianGradient(f.p, ideal, by_u_p, by_v_p)
                     : PerspectiveJacobianGradient(camera, f.p, ideal, by_u_p, by_v_p, by_u, by_v);
  by_u = hn::IfThenElse(ideal.inside_u, by_u, zero);
  by_v = hn::IfThenElse(ideal.inside_v, by_v, zero);
  by_u = by_u + fx * g.x * lens.x_u + fy * g.y * lens.y_u;
  by_v = by_v + fx * g.x * lens.x_v + fy * g.y * lens.y_v;
  if (camera.is_fisheye) return Add(by_p, Add(Scaled(ideal.u_p, by_u), Scaled(ideal.v_p, by_v)));
  const V inverse_z = Constant(1) / hn::Max(f.p.z, Constant(camera.near));
  return Add(by_p, {by_u * inverse_z, by_v * inverse_z,
                    hn::Neg((by_u * ideal.u + by_v * ideal.v) * inverse_z)});
}

// The gradient by the quaternion, from that by the columns of its rotation.
HWY_INLINE void BackThroughRotation(const Footprint& f, const Vector3 (&g)[3], V (&out)[4]) {
  const V two = Constant(2), w = f.qw, x = f.qx, y = f.qy, z = f.qz;
  const V by_w = two * (x * (g[1].z - g[2].y) + y * (g[2].x - g[0].z) + z * (g[0].y - g[1].x));
  const V by_x = two * (w * (g[1].z - g[2].y) - two * x * (g[1].y + g[2].z) +
                        y * (g[1].x + g[0].y) + z * (g[2].x + g[0].z));
  const V by_y = two * (w * (g[2].x - g[0].z) + x * (g[1].x + g[0].y) -
                        two * y * (g[0].x + g[2].z) + z * (g[2].y + g[1].z));
  const V by_z = two * (w * (g[0].y - g[1].x) + x * (g[2].x + g[0].z) + y * (g[2].y + g[1].z) -
                        two * z * (g[0].x + g[1].y));
  const V along = by_w * w + by_x * x + by_y * y + by_z * z;
  out[0] = (by_w - along * w) * f.inverse_length;
  out[1] = (by_x - along * x) * f.inverse_length;
  out[2] = (by_y - along * y) * f.inverse_length;
  out[3] = (by_z - along * z) * f.inverse_length;
}

HWY_INLINE void AddPose(const Footprint& f, const Vector3& by_p, const Vector3& by_direction,
                        const Vector3 (&by_axes)[3], CameraGradient& pose) {
  const D d;
  Vector3 turned = Cross(f.p, by_p);
  for (int k = 0; k < 3; ++k) turned = Add(turned, Cross(f.axes[k], by_axes[k]));
  const Vector3 moved = Add(by_p, by_direction);
  const auto sum = [&](V v)
                       HWY_ATTR { return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v))); };
  pose.turned[0] += sum(turned.x);
  pose.turned[1] += sum(turned.y);
  pose.turned[2] += sum(turned.z);
  pose.moved[0] += sum(moved.x);
  pose.moved[1] += sum(moved.y);
  pose.moved[2] += sum(moved.z);
}

void BackwardImpl(const GaussianCamera& camera, int order, const float* block,
                  const GaussianMoments* moments, float* gradient, float* on_screen,
                  CameraGradient* pose) {
  const D d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  const V zero = hn::Zero(d);
  Footprint f;
  for (int lane = 0; lane < kGaussiansInBlock; lane += kLanes) {
    const float* const p = block + lane;
    float* const out = gradient + lane;
    if (!PlaceMean(camera, p, f)) {
      for (int row = 0; row < GaussianRows(order); ++row) hn::StoreU(zero, d, out + 16 * row);
      hn::StoreU(zero, d, on_screen + lane);
      continue;
    }
    PlaceEllipse(camera, p, f);
    Moments m = LoadMoments(moments + lane);
    // Invisible ones have moments of 0, but their footprint may be infinite.
    const auto keep = [&](V v) HWY_ATTR { return hn::IfThenElseZero(f.visible, v); };
    const EllipseGradient g = BackThroughEllipse(f, m);
    const Vector3 by_j_x = Add(Add(Scaled(f.axes[0], g.a_x.x), Scaled(f.axes[1], g.a_x.y)),
                               Scaled(f.axes[2], g.a_x.z));
    const Vector3 by_j_y = Add(Add(Scaled(f.axes[0], g.a_y.x), Scaled(f.axes[1], g.a_y.y)),
                               Scaled(f.axes[2], g.a_y.z));
    Vector3 by_p = BackThroughLens(camera, f, g, by_j_x, by_j_y);
    by_p = Add(by_p, Scaled(f.p, m.distance / hn::Max(f.distance, Constant(kTiny))));
    const Vector3 by_axes[3] = {Add(Scaled(f.j_x, g.a_x.x), Scaled(f.j_y, g.a_y.x)),
                                Add(Scaled(f.j_x, g.a_x.y), Scaled(f.j_y, g.a_y.y)),
                                Add(Scaled(f.j_x, g.a_x.z), Scaled(f.j_y, g.a_y.z))};
    const Harmonics harmonics = HarmonicsAt(camera, order, f.mean.x, f.mean.y, f.mean.z);
    V by_direction[3];
    ColorGradient(harmonics, order, p + 16 * kColorRow, m.rgb, out + 16 * kColorRow, by_direction);

    const Vector3 by_mean =
        Add(RotatedBack(camera, by_p), {by_direction[0], by_direction[1], by_direction[2]});
    hn::StoreU(keep(by_mean.x), d, out);
    hn::StoreU(keep(by_mean.y), d, out + 16);
    hn::StoreU(keep(by_mean.z), d, out + 32);
    const M bounded[3] = {f.bounded_x, f.bounded_y, f.bounded_z};
    const V scales[3] = {f.scale.x, f.scale.y, f.scale.z};
    Vector3 by_g[3];
    for (int k = 0; k < 3; ++k) {
      const V by_log_scale = Dot(by_axes[k], f.axes[k]);
      hn::StoreU(keep(hn::IfThenElseZero(bounded[k], by_log_scale)), d,
                 out + 16 * (kLogScaleRow + k));
      by_g[k] = RotatedBack(camera, Scaled(by_axes[k], scales[k]));
    }
    V by_q[4];
    BackThroughRotation(f, by_g, by_q);
    for (int k = 0; k < 4; ++k) hn::StoreU(keep(by_q[k]), d, out + 16 * (kRotationRow + k));
    // 1 - sigmoid, without a difference of equal numbers.
    const V logit = hn::Min(hn::LoadU(d, p + 16 * kOpacityRow), Constant(80));
    const V by_opacity = m.sum / (Constant(1) + hn::CallExp(d, hn::Max(logit, Constant(-80))));
    hn::StoreU(keep(by_opacity), d, out + 16 * kOpacityRow);
    hn::StoreU(keep(hn::Sqrt(g.x * g.x + g.y * g.y)), d, on_screen + lane);
    if (pose != nullptr) {
      const auto kept = [&](const Vector3& v) HWY_ATTR {
        return Vector3{keep(v.x), keep(v.y), keep(v.z)};
      };
      const Vector3 direction =
          Rotated(camera, {by_direction[0], by_direction[1], by_direction[2]});
      const Vector3 kept_axes[3] = {kept(by_axes[0]), kept(by_axes[1]), kept(by_axes[2])};
      AddPose(f, kept(by_p), kept(direction), kept_axes, *pose);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {

HWY_EXPORT(ProjectImpl);
HWY_EXPORT(BackwardImpl);

std::int64_t ProjectGaussians(const GaussianCamera& camera, int order,
                              std::span<const float> parameters, std::int64_t first_block,
                              std::int64_t last_block, ProjectedGaussian* out) {
  return HWY_DYNAMIC_DISPATCH(ProjectImpl)(camera, order, parameters.data(), first_block,
                                           last_block, out);
}

void ProjectGaussiansBackward(const GaussianCamera& camera, int order, std::span<const float> block,
                              const ProjectionGradients& gradients, CameraGradient* pose) {
  HWY_DYNAMIC_DISPATCH(BackwardImpl)
  (camera, order, block.data(), gradients.moments.data(), gradients.parameters.data(),
   gradients.on_screen.data(), pose);
}

}  // namespace nerf::kernels
#endif
