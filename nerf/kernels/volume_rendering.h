#pragma once

#include <cstdint>
#include <span>

namespace nerf::kernels {

// The volume-rendering integral of a batch of rays, samples packed ray after ray:
//   x_i = sigma_i dt_i,  T_i = exp(-sum_{j<i} x_j),  w_i = T_i (1 - exp(-x_i))
//   rgb = sum w_i c_i + T_N b,  opacity = sum w_i = 1 - T_N,  depth = sum w_i t_i
// Source: Max 1995; Mildenhall et al. 2020.
//
// Accurate in the hard cases by construction: the optical depth is summed in double, the opacity is
// computed by expm1 (thin fog keeps its opacity), the transmittance by exp of the sum (no product
// of many factors), and the suffix of the gradient is summed from the back (no difference of nearly
// equal colours). An interval of length 0 is empty, whatever its density.
template <class Real>
struct RaySegments {
  std::span<const std::int64_t> ray_begin;  // [R+1] first sample of each ray; the last entry is S
  std::span<const Real> sigma;              // [S]   1 / scene unit, >= 0
  std::span<const Real> dt;                 // [S]   scene units, >= 0
  std::span<const Real> t;                  // [S]   scene units, distance of the sample
  std::span<const Real> radiance;           // [S,3]
  std::span<const Real> background;         // [R,3]
};

template <class Real>
struct Composited {
  std::span<Real> rgb;      // [R,3]
  std::span<Real> opacity;  // [R] in [0,1]
  std::span<Real> depth;  // [R] sum w_i t_i; divided by opacity, the expected depth of the surface
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

// Computes rays [first_ray, last_ray) only, so that a caller can distribute rays over threads.
template <class Real>
void CompositeForward(const RaySegments<Real>& in, const Composited<Real>& out,
                      std::int64_t first_ray, std::int64_t last_ray);

// The backward pass: dL/dx_i = T_{i+1} v_i - (sum_{j>i} w_j v_j + T_N v_b), where
// v = dL/drgb . c + dL/dopacity + dL/ddepth t for a sample and v_b = dL/drgb . b for the
// background.
template <class Real>
void CompositeBackward(const RaySegments<Real>& in, const CompositedGradients<Real>& grad,
                       const SegmentGradients<Real>& out, std::int64_t first_ray,
                       std::int64_t last_ray);

// The weights w_i only, [S], and their backward pass:
//   dL/dx_i = T_{i+1} dL/dw_i - sum_{j>i} w_j dL/dw_j
template <class Real>
void WeightsForward(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                    std::span<const Real> dt, std::span<Real> weights, std::int64_t first_ray,
                    std::int64_t last_ray);
template <class Real>
void WeightsBackward(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                     std::span<const Real> dt, std::span<const Real> dL_dweights,
                     std::span<Real> dL_dsigma, std::int64_t first_ray, std::int64_t last_ray);

// Early termination: the first sample of each ray in front of which the transmittance is below
// stop_transmittance. Samples from there on change the pixel by at most stop_transmittance times
// the largest radiance.
//   kept  [R] written, number of samples of each ray before that one
template <class Real>
void CountVisible(std::span<const std::int64_t> ray_begin, std::span<const Real> sigma,
                  std::span<const Real> dt, double stop_transmittance, std::span<std::int64_t> kept,
                  std::int64_t first_ray, std::int64_t last_ray);

}  // namespace nerf::kernels
