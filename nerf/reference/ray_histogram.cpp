#include "nerf/reference/ray_histogram.h"

#include <cmath>
#include <cstddef>

namespace nerf::reference {
namespace {

long double Centre(std::span<const float> edges, std::size_t i) {
  return (static_cast<long double>(edges[i]) + static_cast<long double>(edges[i + 1])) / 2;
}

long double Length(std::span<const float> edges, std::size_t i) {
  return static_cast<long double>(edges[i + 1]) - static_cast<long double>(edges[i]);
}

}  // namespace

std::vector<long double> Resample(std::span<const float> edges, std::span<const float> weights,
                                  float padding, float jitter, int intervals) {
  const std::size_t size = weights.size();
  long double sum = 0;
  for (const float w : weights) sum += w;
  std::vector<long double> share(size);
  long double total = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const long double even = 1 / static_cast<long double>(size);
    share[i] = sum > 0 ? weights[i] / sum + padding * even : even;
    total += share[i];
  }
  std::vector<long double> positions = {edges.front()};
  for (int m = 1; m < intervals; ++m) {
    const long double wanted = total * (m + static_cast<long double>(jitter) - 0.5L) / intervals;
    long double before = 0;
    std::size_t i = 0;
    while (i + 1 < size && before + share[i] < wanted) before += share[i++];
    const long double fraction = share[i] > 0 ? (wanted - before) / share[i] : 0;
    positions.push_back(edges[i] + fraction * Length(edges, i));
  }
  positions.push_back(edges.back());
  return positions;
}

long double DistortionLoss(std::span<const float> edges, std::span<const float> weights) {
  long double loss = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const long double w_i = weights[i];
    for (std::size_t j = 0; j < weights.size(); ++j) {
      loss += w_i * weights[j] * std::fabs(Centre(edges, i) - Centre(edges, j));
    }
    loss += w_i * w_i * Length(edges, i) / 3;
  }
  return loss;
}

long double DistortionGradient(std::span<const float> edges, std::span<const float> weights,
                               std::size_t k) {
  long double gradient = 2 * static_cast<long double>(weights[k]) * Length(edges, k) / 3;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    gradient += 2 * weights[j] * std::fabs(Centre(edges, k) - Centre(edges, j));
  }
  return gradient;
}

}  // namespace nerf::reference
