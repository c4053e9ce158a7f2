#include "nerf/kernels/adam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace nerf::kernels {
namespace {

TEST(AdamStep, MatchesThePublishedAlgorithm) {
  AdamCoefficients adam;
  adam.learning_rate = 0.01f;
  double p = 0.5, m = 0, v = 0;
  std::vector<float> parameter = {0.5f}, first = {0.0f}, second = {0.0f};
  for (int step = 1; step <= 20; ++step) {
    const double g = std::sin(step);
    m = 0.9 * m + 0.1 * g;
    v = 0.99 * v + 0.01 * g * g;
    const double m_hat = m / (1 - std::pow(0.9, step)), v_hat = v / (1 - std::pow(0.99, step));
    p -= 0.01 * m_hat / (std::sqrt(v_hat) + 1e-15);
    std::vector<float> gradient = {static_cast<float>(g)};
    EXPECT_TRUE(AdamStep(adam, BiasCorrection(adam, step), parameter, gradient, first, second));
    EXPECT_EQ(gradient[0], 0.0f);
    EXPECT_NEAR(parameter[0], p, 1e-5);
  }
}

TEST(AdamStep, AnEntryWithoutGradientIsNotChanged) {
  AdamCoefficients adam;
  adam.learning_rate = 0.01f;
  std::vector<float> parameter = {0.5f}, first = {0.0f}, second = {0.0f};
  std::vector<float> gradient = {0.0f};
  EXPECT_TRUE(AdamStep(adam, BiasCorrection(adam, 1), parameter, gradient, first, second));
  EXPECT_EQ(parameter[0], 0.5f);
}

TEST(AdamStep, BiasCorrectionsEndWhereTheyAreOne) {
  const auto corrections = BiasCorrections({});
  for (std::size_t n = 1; n < corrections.size(); ++n) {
    const double first = 1 - std::pow(static_cast<double>(0.9f), n);
    const double second = 1 - std::pow(static_cast<double>(0.99f), n);
    EXPECT_NEAR(corrections[n].first, 1 / first, 1e-6 / first);
    EXPECT_NEAR(corrections[n].root_second, 1 / std::sqrt(second), 1e-6 / std::sqrt(second));
  }
  EXPECT_EQ(corrections.back().first, 1.0f);
  EXPECT_EQ(corrections.back().root_second, 1.0f);
  EXPECT_LT(corrections.size(), 3000u);
}

TEST(AdamStep, ReportsANonFiniteGradient) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    for (std::size_t at = 0; at < 37; ++at) {
      std::vector<float> parameter(37, 1.0f), gradient(37, 0.1f), first(37), second(37);
      gradient[at] = bad;
      EXPECT_FALSE(AdamStep({}, {}, parameter, gradient, first, second));
    }
  }
}

}  // namespace
}  // namespace nerf::kernels
