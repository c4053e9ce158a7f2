#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "nerf/base/random.h"

namespace nerf::test {

// Uniform numbers in [0,1)^3, functions of a seed and an index.
inline Eigen::Array3d Uniform3(std::uint64_t seed, std::uint64_t index) {
  return {RandomFloat(seed, 0, index), RandomFloat(seed, 1, index), RandomFloat(seed, 2, index)};
}

// Tests whether samples on the sphere follow a density, by Pearson's chi-square over bins of equal
// solid angle (uniform in z and phi). Returns the deviation from its expectation in standard
// deviations, about 0 +- 1 if they follow it (chi-square of many degrees of freedom is nearly
// normal).
//   draw     unit direction, or the zero vector for a rejected sample
//   density  1 / sr
//   inner    quadrature points per bin and axis for the density; many if it has steps
inline double ChiSquareDeviation(const std::function<Eigen::Vector3d(std::uint64_t)>& draw,
                                 const std::function<double(const Eigen::Vector3d&)>& density,
                                 int inner = 16, int draws = 200'000) {
  constexpr int kZ = 24;
  constexpr int kPhi = 32;
  const auto direction = [](double z, double phi) {
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return Eigen::Vector3d(r * std::cos(phi), r * std::sin(phi), z);
  };
  std::vector<double> expected(kZ * kPhi, 0);
  std::vector<double> counted(kZ * kPhi, 0);
  for (int i = 0; i < kZ; ++i) {
    for (int j = 0; j < kPhi; ++j) {
      double sum = 0;
      for (int a = 0; a < inner; ++a) {
        for (int b = 0; b < inner; ++b) {
          sum += density(direction(-1 + 2 * (i + (a + 0.5) / inner) / kZ,
                                   2 * std::numbers::pi * (j + (b + 0.5) / inner) / kPhi));
        }
      }
      expected[i * kPhi + j] = draws * sum / (inner * inner) * 4 * std::numbers::pi / (kZ * kPhi);
    }
  }
  for (int n = 0; n < draws; ++n) {
    const Eigen::Vector3d w = draw(static_cast<std::uint64_t>(n));
    if (w.isZero()) continue;
    const int i = std::clamp(static_cast<int>((w.z() + 1) / 2 * kZ), 0, kZ - 1);
    double phi = std::atan2(w.y(), w.x());
    if (phi < 0) phi += 2 * std::numbers::pi;
    const int j = std::clamp(static_cast<int>(phi / (2 * std::numbers::pi) * kPhi), 0, kPhi - 1);
    counted[i * kPhi + j] += 1;
  }
  // Bins with few samples are pooled, so that the sum is nearly normal.
  double chi2 = 0;
  int bins = 0;
  double pooled_expected = 0;
  double pooled_counted = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] < 10) {
      pooled_expected += expected[i];
      pooled_counted += counted[i];
      continue;
    }
    chi2 += std::pow(counted[i] - expected[i], 2) / expected[i];
    ++bins;
  }
  if (pooled_expected > 5) {
    chi2 += std::pow(pooled_counted - pooled_expected, 2) / pooled_expected;
    ++bins;
  } else if (pooled_counted > 30) {
    return 1e9;  // samples where the density is 0
  }
  return (chi2 - bins) / std::sqrt(2.0 * bins);
}

}  // namespace nerf::test
