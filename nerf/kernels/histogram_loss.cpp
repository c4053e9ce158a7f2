#include "nerf/kernels/histogram_loss.h"

#include <algorithm>
#include <cstddef>

namespace nerf::kernels {

template <class Real>
double HistogramBoundLoss(std::span<const Real> edges, std::span<const Real> weights,
                          std::span<const Real> coarse_edges, std::span<const Real> coarse_weights,
                          std::span<Real> dL_dcoarse) {
  constexpr double kEpsilon = 1e-7;
  std::fill(dL_dcoarse.begin(), dL_dcoarse.end(), Real(0));
  double loss = 0;
  std::size_t first = 0;  // first coarse interval that ends behind the beginning of the fine one
  for (std::size_t i = 0; i < weights.size(); ++i) {
    while (first + 1 < coarse_weights.size() && coarse_edges[first + 1] <= edges[i]) ++first;
    double bound = 0;
    std::size_t last = first;
    for (; last < coarse_weights.size() && coarse_edges[last] < edges[i + 1]; ++last) {
      bound += static_cast<double>(coarse_weights[last]);
    }
    const double excess = static_cast<double>(weights[i]) - bound;
    if (!(excess > 0)) continue;
    const double scale = 1.0 / (static_cast<double>(weights[i]) + kEpsilon);
    loss += excess * excess * scale;
    const auto gradient = static_cast<Real>(-2.0 * excess * scale);
    for (std::size_t j = first; j < last; ++j) dL_dcoarse[j] += gradient;
  }
  return loss;
}

template <class Real>
double DistortionLoss(std::span<const Real> edges, std::span<const Real> weights,
                      std::span<Real> dL_dweight) {
  const auto centre = [&](std::size_t i) {
    return 0.5 * (static_cast<double>(edges[i]) + static_cast<double>(edges[i + 1]));
  };
  // With W and M the sums of w_j and w_j m_j over j < i, the intervals before i contribute
  // w_i (m_i W - M), and those behind it likewise from the other end: O(N) for the double sum.
  double all_w = 0, all_m = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    all_w += static_cast<double>(weights[i]);
    all_m += static_cast<double>(weights[i]) * centre(i);
  }
  double loss = 0, before_w = 0, before_m = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto w = static_cast<double>(weights[i]);
    const double m = centre(i);
    const double length = static_cast<double>(edges[i + 1]) - static_cast<double>(edges[i]);
    const double behind_w = all_w - before_w - w, behind_m = all_m - before_m - w * m;
    const double spread = (m * before_w - before_m) + (behind_m - m * behind_w);
    loss += w * spread + w * w * length / 3.0;
    dL_dweight[i] = static_cast<Real>(2.0 * spread + 2.0 / 3.0 * w * length);
    before_w += w;
    before_m += w * m;
  }
  return loss;
}

#define NERF_INSTANTIATE(Real)                                                     \
  template double HistogramBoundLoss(std::span<const Real>, std::span<const Real>, \
                                     std::span<const Real>, std::span<const Real>, \
                                     std::span<Real>);                             \
  template double DistortionLoss(std::span<const Real>, std::span<const Real>, std::span<Real>);
NERF_INSTANTIATE(float)
NERF_INSTANTIATE(double)
#undef NERF_INSTANTIATE

}  // namespace nerf::kernels
