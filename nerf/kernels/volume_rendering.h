#pragma once

#include <cstdint>
#include <span>

namespace nerf::kernels {

// The volume-rendering integral of a batch of rays, samples packed ray after ray:
//   x_i = sigma_i dt_i,  T_i = exp(-sum_{j<i} x_j),  w_i = T_i (1 - exp(-x_i))
//   rgb = sum w_i c_i + T_N b,  opacity = sum w_i = 1 - T_N,  depth = sum w_i t_i
// Source: Max 1995; Mildenhall et al. 2020.
//
// Right in the hard cases by construction: the optical depth is summed in double, opacity comes
// from expm1 (thin fog keeps its opacity), transmittance from exp of the sum (no product of many
// factors), and the gradient's suffix is summed from the back (no difference of near-equal
// colours). An interval of length 0 counts as empty, whatever its density.
template <class Real>
struct RaySegments {
  std::span<const std::int64_t> ray_begin;  // [R+1] first sample of each ray; the last entry is S
  std::span<const Real> sigma;              // [S]   1 / scene unit, >= 0
  std::span<const Real> dt;                 // [S]   scene units, >= 0
  std::span<const Real> t;                  // [S]   scene units, where the sample stands on its ray
  std::span<const Real> radiance;           // [S,3]
  std::span<const Real> background;         // [R,3]
};

template <class Real>
struct Composited {
  std::span<Real> rgb;      // [R,3]
  std::span<Real> opacity;  // [R] in [0,1]
  std::span<Real>
      depth;  // [R] sum w_i t_i: divide by opacity for the expected depth of what was hit
};

template <class Real>
struct CompositedGradients {
  std::span<const Real> dL_drgb;      // [R,3]
  std::span<const Real> dL_dopacity;  // [R]
  std::span<const Real> dL_ddepth;    // [R]
};

template <class Real>
struct SegmentGradients {
  std::span<Real> dL_dsigma;       // [S]
  std::span<Real> dL_dradiance;    // [S,3]
  std::span<Real> dL_dbackground;  // [R,3]
};

// Rays [first_ray, last_ray) only, so that a caller can deal rays out to threads.
template <class Real>
void CompositeForward(const RaySegments<Real>& in, const Composited<Real>& out,
                      std::int64_t first_ray, std::int64_t last_ray);

// dL/dx_i = T_{i+1} v_i - (sum_{j>i} w_j v_j + T_N v_b), with v = dL/drgb . c + dL/dopacity +
// dL/ddepth t the value of a sample, and v_b that of the background.
template <class Real>
void CompositeBackward(const RaySegments<Real>& in, const CompositedGradients<Real>& grad,
                       const SegmentGradients<Real>& out, std::int64_t first_ray,
                       std::int64_t last_ray);

// The weights w_i alone, [S], and the way back: dL/dx_i = T_{i+1} dL/dw_i - sum_{j>i} w_j dL/dw_j.
template <class Real>
void WeightsForward(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                    std::span<const Real> dt, std::span<Real> weights, std::int64_t first_ray,
                    std::int64_t last_ray);
template <class Real>
void WeightsBackward(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                     std::span<const Real> dt, std::span<const Real> dL_dweights,
                     std::span<Real> dL_dsigma, std::int64_t first_ray, std::int64_t last_ray);

// First sample of each ray at whose front the transmittance is below stop_transmittance: samples
// from there on cannot change the pixel by more than stop_transmittance times the largest radiance.
//   kept  [R] number of samples of each ray before that point
template <class Real>
void CountVisible(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                  std::span<const Real> dt, double stop_transmittance, std::span<std::int64_t> kept,
                  std::int64_t first_ray, std::int64_t last_ray);

}  // namespace nerf::kernels
