#include "nerf/kernels/volume_rendering.h"

#include <cmath>
#include <vector>

namespace nerf::kernels {
namespace {

// Optical depth of one interval. In double, so that no product of finite floats overflows. Infinite
// density over length 0 is an empty interval.
template <class Real>
double OpticalDepth(Real sigma, Real dt) {
  return dt == Real(0) ? 0.0 : static_cast<double>(sigma) * static_cast<double>(dt);
}

}  // namespace

template <class Real>
void CompositeForward(const RaySegments<Real>& in, const Composited<Real>& out,
                      std::int64_t first_ray, std::int64_t last_ray) {
  for (std::int64_t ray = first_ray; ray < last_ray; ++ray) {
    double tau = 0;  // optical depth in front of the sample
    double rgb[3] = {0, 0, 0};
    double depth = 0;
    for (std::int64_t i = in.ray_begin[ray]; i < in.ray_begin[ray + 1]; ++i) {
      const double x = OpticalDepth(in.sigma[i], in.dt[i]);
      const double weight = std::exp(-tau) * -std::expm1(-x);
      for (int c = 0; c < 3; ++c) rgb[c] += weight * static_cast<double>(in.radiance[3 * i + c]);
      depth += weight * static_cast<double>(in.t[i]);
      tau += x;
    }
    const double T_end = std::exp(-tau);
    for (int c = 0; c < 3; ++c) {
      const double behind = T_end * static_cast<double>(in.background[3 * ray + c]);
      out.rgb[3 * ray + c] = static_cast<Real>(rgb[c] + behind);
    }
    out.opacity[ray] = static_cast<Real>(-std::expm1(-tau));
    out.depth[ray] = static_cast<Real>(depth);
  }
}

template <class Real>
void CompositeBackward(const RaySegments<Real>& in, const CompositedGradients<Real>& grad,
                       const SegmentGradients<Real>& out, std::int64_t first_ray,
                       std::int64_t last_ray) {
  std::vector<double> tau;  // tau[k]: optical depth in front of sample k of the ray
  for (std::int64_t ray = first_ray; ray < last_ray; ++ray) {
    const std::int64_t begin = in.ray_begin[ray];
    const std::int64_t count = in.ray_begin[ray + 1] - begin;
    const double g[3] = {static_cast<double>(grad.dL_drgb[3 * ray]),
                         static_cast<double>(grad.dL_drgb[3 * ray + 1]),
                         static_cast<double>(grad.dL_drgb[3 * ray + 2])};
    const double g_opacity = static_cast<double>(grad.dL_dopacity[ray]);
    const double g_depth = static_cast<double>(grad.dL_ddepth[ray]);

    tau.assign(count + 1, 0.0);
    for (std::int64_t k = 0; k < count; ++k) {
      tau[k + 1] = tau[k] + OpticalDepth(in.sigma[begin + k], in.dt[begin + k]);
    }

    const double T_end = std::exp(-tau[count]);
    double suffix = 0;  // sum_{j>k} w_j v_j + T_N v_b
    for (int c = 0; c < 3; ++c) {
      suffix += T_end * g[c] * static_cast<double>(in.background[3 * ray + c]);
      out.dL_dbackground[3 * ray + c] = static_cast<Real>(T_end * g[c]);
    }
    for (std::int64_t k = count - 1; k >= 0; --k) {
      const std::int64_t i = begin + k;
      const double x = OpticalDepth(in.sigma[i], in.dt[i]);
      const double weight = std::exp(-tau[k]) * -std::expm1(-x);
      double value = g_opacity + g_depth * static_cast<double>(in.t[i]);
      for (int c = 0; c < 3; ++c) {
        value += g[c] * static_cast<double>(in.radiance[3 * i + c]);
        out.dL_dradiance[3 * i + c] = static_cast<Real>(weight * g[c]);
      }
      const double dL_dx = std::exp(-tau[k + 1]) * value - suffix;
      out.dL_dsigma[i] = static_cast<Real>(dL_dx * static_cast<double>(in.dt[i]));
      suffix += weight * value;
    }
  }
}

template <class Real>
void WeightsForward(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                    std::span<const Real> dt, std::span<Real> weights, std::int64_t first_ray,
                    std::int64_t last_ray) {
  for (std::int64_t ray = first_ray; ray < last_ray; ++ray) {
    double tau = 0;
    for (std::int64_t i = ray_begin[ray]; i < ray_begin[ray + 1]; ++i) {
      const double x = OpticalDepth(sigma[i], dt[i]);
      weights[i] = static_cast<Real>(std::exp(-tau) * -std::expm1(-x));
      tau += x;
    }
  }
}

template <class Real>
void WeightsBackward(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                     std::span<const Real> dt, std::span<const Real> dL_dweights,
                     std::span<Real> dL_dsigma, std::int64_t first_ray, std::int64_t last_ray) {
  std::vector<double> tau;  // tau[k]: optical depth in front of sample k of the ray
  for (std::int64_t ray = first_ray; ray < last_ray; ++ray) {
    const std::int64_t begin = ray_begin[ray], count = ray_begin[ray + 1] - begin;
    tau.assign(count + 1, 0.0);
    for (std::int64_t k = 0; k < count; ++k) {
      tau[k + 1] = tau[k] + OpticalDepth(sigma[begin + k], dt[begin + k]);
    }
    double suffix = 0;
    for (std::int64_t k = count - 1; k >= 0; --k) {
      const std::int64_t i = begin + k;
      const auto g = static_cast<double>(dL_dweights[i]);
      const double dL_dx = std::exp(-tau[k + 1]) * g - suffix;
      dL_dsigma[i] = static_cast<Real>(dL_dx * static_cast<double>(dt[i]));
      suffix += std::exp(-tau[k]) * -std::expm1(-OpticalDepth(sigma[i], dt[i])) * g;
    }
  }
}

template <class Real>
void CountVisible(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                  std::span<const Real> dt, double stop_transmittance, std::span<std::int64_t> kept,
                  std::int64_t first_ray, std::int64_t last_ray) {
  const double stop_tau = -std::log(stop_transmittance);
  for (std::int64_t ray = first_ray; ray < last_ray; ++ray) {
    double tau = 0;
    std::int64_t i = ray_begin[ray];
    while (i < ray_begin[ray + 1] && tau <= stop_tau) {
      tau += OpticalDepth(sigma[i], dt[i]);
      ++i;
    }
    kept[ray] = i - ray_begin[ray];
  }
}

#define NERF_INSTANTIATE(Real)                                                                     \
  template void CompositeForward(const RaySegments<Real>&, const Composited<Real>&, std::int64_t,  \
                                 std::int64_t);                                                    \
  template void CompositeBackward(const RaySegments<Real>&, const CompositedGradients<Real>&,      \
                                  const SegmentGradients<Real>&, std::int64_t, std::int64_t);      \
  template void WeightsForward(std::span<const std::int64_t>, std::span<const Real>,               \
                               std::span<const Real>, std::span<Real>, std::int64_t,               \
                               std::int64_t);                                                      \
  template void WeightsBackward(std::span<const std::int64_t>, std::span<const Real>,              \
                                std::span<const Real>, std::span<const Real>, std::span<Real>,     \
                                std::int64_t, std::int64_t);                                       \
  template void CountVisible(std::span<const std::int64_t>, std::span<const Real>,                 \
                             std::span<const Real>, double, std::span<std::int64_t>, std::int64_t, \
                             std::int64_t);
NERF_INSTANTIATE(float)
NERF_INSTANTIATE(double)
#undef NERF_INSTANTIATE

}  // namespace nerf::kernels
