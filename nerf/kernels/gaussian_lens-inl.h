// The lens of GaussianCamera and its derivatives, on vectors. Included once for each SIMD level.
#if defined(NERF_KERNELS_GAUSSIAN_LENS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NERF_KERNELS_GAUSSIAN_LENS_INL_H_
#undef NERF_KERNELS_GAUSSIAN_LENS_INL_H_
#else
#define NERF_KERNELS_GAUSSIAN_LENS_INL_H_
#endif

#include <hwy/highway.h>

#include "nerf/kernels/gaussian_vectors-inl.h"
#include "nerf/kernels/gaussians.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {

// Distortion at a point (u, v) of the ideal plane, s = u^2 + v^2:
//   (u, v) c(s) + tangential + prism s,  c = N(s) / D(s)
struct LensAt {
  V u, v, s;
  V c, c1, c2;           // c and its derivatives by s
  V x, y;                // distorted
  V x_u, x_v, y_u, y_v;  // the Jacobian
};

// Value, first and second derivative of a polynomial.
template <std::size_t N>
HWY_INLINE void EvaluateWithDerivatives(const std::array<float, N>& coefficients, V s, V& p, V& p1,
                                        V& p2) {
  p = Constant(coefficients[N - 1]);
  p1 = p2 = hn::Zero(D());
  for (std::size_t i = N - 1; i-- > 0;) {
    p2 = hn::MulAdd(p2, s, p1);
    p1 = hn::MulAdd(p1, s, p);
    p = hn::MulAdd(p, s, Constant(coefficients[i]));
  }
  p2 = p2 + p2;
}

HWY_INLINE void EvaluateLens(const GaussianCamera& camera, V u, V v, LensAt& at) {
  const V one = Constant(1), zero = hn::Zero(D());
  at.u = u;
  at.v = v;
  if (camera.is_pinhole) {
    at.x = u;
    at.y = v;
    at.x_u = at.y_v = at.c = one;
    at.x_v = at.y_u = at.c1 = at.c2 = at.s = zero;
    return;
  }
  at.s = u * u + v * v;
  V n, n1, n2, d, d1, d2;
  EvaluateWithDerivatives(camera.numerator, at.s, n, n1, n2);
  EvaluateWithDerivatives(camera.denominator, at.s, d, d1, d2);
  const V inverse = one / d;
  at.c = n * inverse;
  at.c1 = (n1 - at.c * d1) * inverse;
  at.c2 = (n2 - (at.c1 + at.c1) * d1 - at.c * d2) * inverse;
  const V p1 = Constant(camera.tangential[0]), p2 = Constant(camera.tangential[1]);
  const V b1 = Constant(camera.prism[0]), b2 = Constant(camera.prism[1]);
  const V two = Constant(2), six = Constant(6), uv = u * v;
  at.x = u * at.c + two * p1 * uv + p2 * (at.s + two * u * u) + b1 * at.s;
  at.y = v * at.c + two * p2 * uv + p1 * (at.s + two * v * v) + b2 * at.s;
  const V bend = two * (p1 * u + p2 * v), radial = two * at.c1;
  at.x_u = at.c + radial * u * u + two * p1 * v + six * p2 * u + two * b1 * u;
  at.x_v = radial * uv + bend + two * b1 * v;
  at.y_u = radial * uv + bend + two * b2 * u;
  at.y_v = at.c + radial * v * v + six * p1 * v + two * p2 * u + two * b2 * v;
}

// The gradient by u and v of the sum of the entries of the Jacobian, each times its weight.
HWY_INLINE void LensJacobianGradient(const GaussianCamera& camera, const LensAt& at, V g_xu, V g_xv,
                                     V g_yu, V g_yv, V& by_u, V& by_v) {
  by_u = by_v = hn::Zero(D());
  if (camera.is_pinhole) return;
  const V two = Constant(2), six = Constant(6);
  const V p1 = Constant(camera.tangential[0]), p2 = Constant(camera.tangential[1]);
  const V b1 = Constant(camera.prism[0]), b2 = Constant(camera.prism[1]);
  const V trace = g_xu + g_yv, mixed = g_xv + g_yu;
  const V quadratic = at.u * (g_xu * at.u + mixed * at.v) + at.v * g_yv * at.v;
  const V along = two * at.c1 * trace + two * two * at.c2 * quadratic;
  const V across = two * at.c1;
  by_u = along * at.u + across * (two * g_xu * at.u + mixed * at.v) + six * p2 * g_xu +
         two * p1 * mixed + two * p2 * g_yv + two * (b1 * g_xu + b2 * g_yu);
  by_v = along * at.v + across * (two * g_yv * at.v + mixed * at.u) + two * p1 * g_xu +
         two * p2 * mixed + six * p1 * g_yv + two * (b1 * g_xv + b2 * g_yv);
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();
#endif
