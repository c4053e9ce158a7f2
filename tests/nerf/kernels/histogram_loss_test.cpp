#include "nerf/kernels/histogram_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace nerf::kernels {
namespace {

std::vector<float> Rising(int count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> step(0.01f, 1.0f);
  std::vector<float> edges = {0.0f};
  for (int i = 0; i < count; ++i) edges.push_back(edges.back() + step(generator));
  for (float& edge : edges) edge /= edges.back();
  return edges;
}

std::vector<float> Weights(int count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 2.0f / static_cast<float>(count));
  std::vector<float> weights(count);
  for (float& weight : weights) weight = uniform(generator);
  return weights;
}

// Compares dL/dw by central differences with `gradient`.
void ExpectGradient(std::vector<float> w, const std::vector<float>& gradient,
                    const std::function<double(const std::vector<float>&)>& loss) {
  for (std::size_t i = 0; i < w.size(); ++i) {
    const float at = w[i], h = 1e-3f;
    w[i] = at + h;
    const double above = loss(w), high = w[i];
    w[i] = at - h;
    const double below = loss(w), low = w[i];
    w[i] = at;
    const double numeric = (above - below) / (high - low);
    EXPECT_NEAR(gradient[i], numeric, 2e-3 * (1 + std::fabs(numeric))) << i;
  }
}

TEST(HistogramBoundLoss, MatchesTheSumOverOverlappingPairsInValueAndGradient) {
  for (std::uint32_t seed = 1; seed < 6; ++seed) {
    const auto edges = Rising(17, seed), coarse_edges = Rising(9, seed + 10);
    const auto weights = Weights(17, seed + 20);
    auto coarse = Weights(9, seed + 30);
    for (float& w : coarse) w *= 0.3f;
    std::vector<float> gradient(9);
    const auto loss_of = [&](const std::vector<float>& of) {
      std::vector<float> unused(9);
      return HistogramBoundLoss<float>(edges, weights, coarse_edges, of, unused);
    };
    const double loss = HistogramBoundLoss<float>(edges, weights, coarse_edges, coarse, gradient);
    double expected = 0;
    for (int i = 0; i < 17; ++i) {
      double bound = 0;
      for (int j = 0; j < 9; ++j) {
        if (coarse_edges[j] < edges[i + 1] && edges[i] < coarse_edges[j + 1]) bound += coarse[j];
      }
      const double excess = std::max(0.0, weights[i] - bound);
      expected += excess * excess / (weights[i] + 1e-7);
    }
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(loss, expected, 1e-6);
    ExpectGradient(coarse, gradient, loss_of);
  }
}

TEST(HistogramBoundLoss, IsZeroUnderAnEnvelope) {
  const auto edges = Rising(20, 1), coarse_edges = Rising(5, 2);
  const auto weights = Weights(20, 3);
  std::vector<float> gradient(5, 7.0f);
  const std::vector<float> envelope(5, 1.0f);
  EXPECT_EQ(HistogramBoundLoss<float>(edges, weights, coarse_edges, envelope, gradient), 0.0);
  EXPECT_EQ(gradient, std::vector<float>(5, 0.0f));
}

TEST(HistogramBoundLoss, IsZeroForRaysWithoutWeight) {
  const auto edges = Rising(6, 1);
  const std::vector<float> none(6, 0.0f);
  std::vector<float> gradient(6);
  EXPECT_EQ(HistogramBoundLoss<float>(edges, none, edges, none, gradient), 0.0);
}

TEST(DistortionLoss, MatchesTheDoubleSumInValueAndGradient) {
  for (std::uint32_t seed = 1; seed < 6; ++seed) {
    const auto edges = Rising(13, seed);
    const auto weights = Weights(13, seed + 20);
    double expected = 0;
    for (int i = 0; i < 13; ++i) {
      const double mi = 0.5 * (edges[i] + edges[i + 1]);
      for (int j = 0; j < 13; ++j) {
        expected += weights[i] * weights[j] * std::fabs(mi - 0.5 * (edges[j] + edges[j + 1]));
      }
      expected += weights[i] * weights[i] * (edges[i + 1] - edges[i]) / 3;
    }
    std::vector<float> gradient(13);
    EXPECT_NEAR(DistortionLoss<float>(edges, weights, gradient), expected, 1e-6);
    ExpectGradient(weights, gradient, [&](const std::vector<float>& of) {
      std::vector<float> unused(13);
      return DistortionLoss<float>(edges, of, unused);
    });
  }
}

TEST(DistortionLoss, PrefersOnePlaceToTwo) {
  const std::vector<float> edges = {0.0f, 0.1f, 0.2f, 0.9f, 1.0f};
  std::vector<float> gradient(4);
  const double one = DistortionLoss<float>(edges, std::vector<float>{1, 0, 0, 0}, gradient);
  const double two = DistortionLoss<float>(edges, std::vector<float>{0.5f, 0, 0, 0.5f}, gradient);
  EXPECT_LT(one, two);
}

}  // namespace
}  // namespace nerf::kernels
