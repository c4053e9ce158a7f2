#pragma once

#include <span>

namespace nerf::kernels {

// The loss of a proposal network: the excess of a ray's weights over an upper bound from a coarser
// histogram of the same ray, the sum of the coarse weights whose intervals overlap that of a
// weight.
//   L = sum_i max(0, w_i - bound_i)^2 / (w_i + epsilon)
// Source: Barron et al. 2022, "Mip-NeRF 360", equation 13. Differentiable in the coarse weights
// only, which so learn to cover the fine ones.
//   edges, weights                [M+1] ascending, [M]
//   coarse_edges, coarse_weights  [N+1] ascending, [N]
//   dL_dcoarse                    [N] written
//   returns  L
template <class Real>
double HistogramBoundLoss(std::span<const Real> edges, std::span<const Real> weights,
                          std::span<const Real> coarse_edges, std::span<const Real> coarse_weights,
                          std::span<Real> dL_dcoarse);

// The distortion loss: the spread of a ray's weights. Minimizing it concentrates them in one place
// and so removes floaters.
//   L = sum_ij w_i w_j |m_i - m_j| + 1/3 sum_i w_i^2 (s_{i+1} - s_i),  m_i the centre of interval i
// Source: Barron et al. 2022, equation 15.
//   edges       [M+1] ascending    weights  [M]
//   dL_dweight  [M] written
//   returns  L
template <class Real>
double DistortionLoss(std::span<const Real> edges, std::span<const Real> weights,
                      std::span<Real> dL_dweight);

}  // namespace nerf::kernels
