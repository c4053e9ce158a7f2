#pragma once

#include <span>
#include <vector>

namespace nerf::reference {

// The ends of a histogram, and between them the positions at which its cumulative distribution
// reaches (m + jitter - 1/2) / intervals, m = 1, 2, ..., each by its own search from the front.
//   edges [N+1], weights [N]; padding as in ResampleIntervals    returns  [intervals + 1]
std::vector<long double> Resample(std::span<const float> edges, std::span<const float> weights,
                                  float padding, float jitter, int intervals);

// Barron et al. 2022, equation 15, by the double sum.
long double DistortionLoss(std::span<const float> edges, std::span<const float> weights);

// The derivative of DistortionLoss by weight k: 2 sum_j w_j |m_k - m_j| + 2/3 w_k (s_{k+1} - s_k).
long double DistortionGradient(std::span<const float> edges, std::span<const float> weights,
                               std::size_t k);

}  // namespace nerf::reference
