// From points in the camera to the ideal plane of its lens. Included once for each SIMD level.
#if defined(NERF_KERNELS_GAUSSIAN_IDEAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NERF_KERNELS_GAUSSIAN_IDEAL_INL_H_
#undef NERF_KERNELS_GAUSSIAN_IDEAL_INL_H_
#else
#define NERF_KERNELS_GAUSSIAN_IDEAL_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "nerf/kernels/gaussian_vectors-inl.h"
#include "nerf/kernels/gaussians.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {

// Closer to the axis of a fisheye than this tangent, series replace differences of equal numbers.
constexpr float kNearAxis = 0.25f;

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

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();
#endif
