#include "nerf/kernels/activations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/simd_levels.h"

namespace nerf::kernels {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Activations : public test::EverySimdLevel {
 protected:
  // Odd in number, so that the last vector is not full.
  static std::vector<float> Arguments() {
    std::vector<float> x;
    for (float v = -40.0f; v <= 40.0f; v += 0.37f) x.push_back(v);
    if (x.size() % 2 == 0) x.push_back(0.5f);
    return x;
  }
};

void ExpectClose(float value, double exact) {
  EXPECT_NEAR(value, exact, 4 * 1.2e-7 * exact) << exact;
}

TEST_P(Activations, TruncatedExpIsExpBetweenItsLimits) {
  const auto arguments = Arguments();
  auto x = arguments;
  TruncatedExp(x, -1.0f, 15.0f);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double argument = static_cast<double>(arguments[i] - 1.0f);
    ExpectClose(x[i], std::exp(std::clamp(argument, -15.0, 15.0)));
  }
}

TEST_P(Activations, SigmoidIsTheLogisticFunction) {
  const auto arguments = Arguments();
  auto x = arguments;
  Sigmoid(x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    ExpectClose(x[i], 1.0 / (1.0 + std::exp(-static_cast<double>(arguments[i]))));
  }
}

TEST_P(Activations, ExtremesStayFiniteAndNaNStaysNaN) {
  std::vector<float> x = {kInfinity, -kInfinity, 3e38f, -3e38f, NAN, 1e-40f, -0.0f};
  auto y = x;
  TruncatedExp(x, 0.0f, 15.0f);
  Sigmoid(y);
  ExpectClose(x[0], std::exp(15.0));
  ExpectClose(x[1], std::exp(-15.0));
  ExpectClose(x[2], std::exp(15.0));
  ExpectClose(x[3], std::exp(-15.0));
  EXPECT_EQ(y[0], 1.0f);
  EXPECT_EQ(y[2], 1.0f);
  EXPECT_GE(y[1], 0.0f);
  EXPECT_LT(y[1], 1e-30f);
  EXPECT_LT(y[3], 1e-30f);
  EXPECT_TRUE(std::isnan(x[4]));
  EXPECT_TRUE(std::isnan(y[4]));
  EXPECT_EQ(y[5], 0.5f);
  EXPECT_EQ(y[6], 0.5f);
}

NERF_FOR_EVERY_SIMD_LEVEL(Activations);

}  // namespace
}  // namespace nerf::kernels
