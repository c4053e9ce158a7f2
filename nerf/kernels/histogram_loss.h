#pragma once

#include <span>

namespace nerf::kernels {

// How far the weights of a ray rise above what a coarser histogram of the same ray allows: each
// weight may be as large as the sum of the coarse weights whose intervals overlap its own.
//   L = sum_i max(0, w_i - bound_i)^2 / (w_i + epsilon)
// Source: Barron et al. 2022, "Mip-NeRF 360", equation 13. Its gradient goes to the coarse weights
// alone, which learn to stand wherever the fine ones do.
//   edges, weights                [M+1] rising, [M]
//   coarse_edges, coarse_weights  [N+1] rising, [N]
//   dL_dcoarse                    [N] written
//   returns  L
template <class Real>
double HistogramBoundLoss(std::span<const Real> edges, std::span<const Real> weights,
                          std::span<const Real> coarse_edges, std::span<const Real> coarse_weights,
                          std::span<Real> dL_dcoarse);

// How far a ray's weights are spread: pulls them together into one place, and so floaters, which
// are a second place, into nothing.
//   L = sum_ij w_i w_j |m_i - m_j| + 1/3 sum_i w_i^2 (s_{i+1} - s_i),  m_i the middle of interval i
// Source: Barron et al. 2022, equation 15.
//   edges       [M+1] rising    weights  [M]
//   dL_dweight  [M] written
//   returns  L
template <class Real>
double DistortionLoss(std::span<const Real> edges, std::span<const Real> weights,
                      std::span<Real> dL_dweight);

}  // namespace nerf::kernels
