#include "nerf/inspect/photograph_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace nerf {
namespace {

// Sightings of points by photographs with the exposures e, a part of them of something else.
std::vector<Sighting> Sightings(int points, const std::vector<float>& e, double part_wrong) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<Sighting> all;
  for (int p = 0; p < points; ++p) {
    const Eigen::Vector3f of_point(std::sin(1.0f * p), std::cos(2.0f * p), std::sin(3.0f * p));
    for (int i = 0; i < static_cast<int>(e.size()); ++i) {
      if (uniform(generator) < 0.5f) continue;
      const float wrong = uniform(generator) < part_wrong ? 3.0f : 0.0f;
      all.push_back({p, i, of_point.array() + e[i] + wrong});
    }
  }
  return all;
}

TEST(PhotographFit, SeparatesPointsAndPhotographs) {
  const std::vector<float> e = {-0.6f, -0.1f, 0.0f, 0.2f, 0.5f};
  const auto sightings = Sightings(200, e, 0);
  const PhotographFit fit = FitPhotographs(sightings, 200, e.size());
  for (std::size_t i = 0; i < e.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fit.of_photograph[i][c], e[i], 1e-3);
  }
  for (const auto& residual : fit.residuals) EXPECT_LT(residual.norm(), 5e-3);
}

TEST(PhotographFit, IsNotBiasedByPassersBy) {
  const std::vector<float> e = {-0.6f, -0.1f, 0.0f, 0.2f, 0.5f};
  const PhotographFit fit = FitPhotographs(Sightings(400, e, 0.15), 400, e.size());
  for (std::size_t i = 0; i < e.size(); ++i) {
    EXPECT_NEAR(fit.of_photograph[i][0] - fit.of_photograph[0][0], e[i] - e[0], 0.02);
  }
}

}  // namespace
}  // namespace nerf
