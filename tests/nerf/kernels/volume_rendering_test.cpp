#include "nerf/kernels/volume_rendering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "nerf/reference/volume_rendering.h"

namespace nerf::kernels {
namespace {

// One ray through both the kernel (in float) and the long double oracle.
struct RayCase {
  std::vector<float> sigma, dt, t, radiance;
  float background[3] = {0.2f, 0.4f, 0.6f};

  void Add(float s, float length, float r = 0.5f, float g = 0.25f, float b = 0.75f) {
    const float begin = t.empty() ? 1.0f : t.back() + 0.5f * dt.back();
    sigma.push_back(s);
    dt.push_back(length);
    t.push_back(begin + 0.5f * length);
    radiance.insert(radiance.end(), {r, g, b});
  }

  reference::Ray Oracle() const {
    reference::Ray ray;
    ray.sigma.assign(sigma.begin(), sigma.end());
    ray.dt.assign(dt.begin(), dt.end());
    ray.t.assign(t.begin(), t.end());
    ray.radiance.assign(radiance.begin(), radiance.end());
    for (int c = 0; c < 3; ++c) ray.background[c] = background[c];
    return ray;
  }
};

struct Result {
  float rgb[3], opacity, depth;
};

RaySegments<float> Segments(const RayCase& ray, const std::vector<std::int64_t>& begin) {
  return {begin, ray.sigma, ray.dt, ray.t, ray.radiance, ray.background};
}

Result Forward(const RayCase& ray) {
  const std::vector<std::int64_t> begin = {0, static_cast<std::int64_t>(ray.sigma.size())};
  Result result{};
  CompositeForward<float>(Segments(ray, begin),
                          {result.rgb, {&result.opacity, 1}, {&result.depth, 1}}, 0, 1);
  return result;
}

struct Gradients {
  std::vector<float> sigma, radiance;
  float background[3];
};

Gradients Backward(const RayCase& ray, const float (&g_rgb)[3], float g_opacity, float g_depth) {
  const auto samples = static_cast<std::int64_t>(ray.sigma.size());
  const std::vector<std::int64_t> begin = {0, samples};
  Gradients out{std::vector<float>(samples), std::vector<float>(3 * samples), {}};
  CompositeBackward<float>(Segments(ray, begin), {g_rgb, {&g_opacity, 1}, {&g_depth, 1}},
                           {out.sigma, out.radiance, out.background}, 0, 1);
  return out;
}

RayCase RandomRay(int samples, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  RayCase ray;
  for (int i = 0; i < samples; ++i) {
    ray.Add(std::exp(6 * uniform(rng) - 3), 0.1f * uniform(rng), uniform(rng), uniform(rng),
            uniform(rng));
  }
  return ray;
}

void ExpectMatchesOracle(const RayCase& ray, double tolerance) {
  const Result result = Forward(ray);
  const reference::Pixel oracle = reference::Composite(ray.Oracle());
  const auto near = [&](float value, long double truth) {
    EXPECT_NEAR(value, static_cast<double>(truth), tolerance * std::fabs(truth) + 1e-30);
  };
  for (int c = 0; c < 3; ++c) near(result.rgb[c], oracle.rgb[c]);
  near(result.opacity, oracle.opacity);
  near(result.depth, oracle.depth);
}

TEST(VolumeRendering, MatchesTheOracleOnRandomRays) {
  for (unsigned seed = 0; seed < 50; ++seed) ExpectMatchesOracle(RandomRay(64, seed), 1e-6);
}

TEST(VolumeRendering, GradientsMatchTheOracleOnRandomRays) {
  const float g_rgb[3] = {0.3f, -0.7f, 0.2f};
  const long double g[3] = {g_rgb[0], g_rgb[1], g_rgb[2]};
  for (unsigned seed = 0; seed < 50; ++seed) {
    const RayCase ray = RandomRay(48, seed);
    const Gradients gradients = Backward(ray, g_rgb, 0.4f, -0.1f);
    const auto oracle = reference::GradientOfSigma(ray.Oracle(), g, 0.4f, -0.1f);
    for (std::size_t i = 0; i < ray.sigma.size(); ++i) {
      EXPECT_NEAR(gradients.sigma[i], static_cast<double>(oracle[i]),
                  1e-6 * std::fabs(oracle[i]) + 1e-12);
      const auto weight = static_cast<double>(reference::Weight(ray.Oracle(), i));
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(gradients.radiance[3 * i + c], weight * g_rgb[c], 1e-6 * weight + 1e-30);
      }
    }
    const auto T_end =
        static_cast<double>(reference::TransmittanceBefore(ray.Oracle(), ray.sigma.size()));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(gradients.background[c], T_end * g_rgb[c], 1e-7);
  }
}

TEST(VolumeRendering, EmptySpaceShowsTheBackgroundAndHasAGradient) {
  RayCase ray;
  for (int i = 0; i < 8; ++i) ray.Add(0.0f, 0.1f);
  const Result result = Forward(ray);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(result.rgb[c], ray.background[c]);
  EXPECT_EQ(result.opacity, 0.0f);
  const Gradients gradients = Backward(ray, {1, 0, 0}, 0, 0);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(gradients.sigma[i], 0.1f * (0.5f - 0.2f), 1e-7);  // dt (c - b)
  }
}

TEST(VolumeRendering, ARayWithoutSamplesShowsItsBackground) {
  const Result result = Forward(RayCase{});
  for (int c = 0; c < 3; ++c) EXPECT_EQ(result.rgb[c], RayCase{}.background[c]);
  EXPECT_EQ(result.opacity, 0.0f);
  EXPECT_EQ(result.depth, 0.0f);
}

TEST(VolumeRendering, ThinFogKeepsItsOpacity) {
  for (const double tau : {1e-6, 1e-5, 1e-4, 1e-3}) {
    RayCase ray;
    for (int i = 0; i < 1024; ++i) ray.Add(static_cast<float>(tau / 1024 / 0.01), 0.01f);
    long double exact_tau = 0;
    for (int i = 0; i < 1024; ++i) {
      exact_tau += static_cast<long double>(ray.sigma[i]) * static_cast<long double>(ray.dt[i]);
    }
    const auto truth = static_cast<double>(-std::expm1(-exact_tau));
    EXPECT_NEAR(Forward(ray).opacity, truth, 1e-6 * truth) << "optical depth " << tau;
  }
}

TEST(VolumeRendering, AnOpaqueSampleHidesWhatIsBehindItWithFiniteGradients) {
  RayCase ray;
  ray.Add(0.5f, 0.1f);
  ray.Add(1e10f, 1.0f, 1.0f, 0.0f, 0.0f);
  ray.Add(3.0f, 0.1f);
  const Result result = Forward(ray);
  EXPECT_EQ(result.opacity, 1.0f);
  const Gradients gradients = Backward(ray, {1, 1, 1}, 0, 0);
  for (const float g : gradients.sigma) EXPECT_TRUE(std::isfinite(g));
  EXPECT_NE(gradients.sigma[0], 0.0f);
  EXPECT_EQ(gradients.sigma[2], 0.0f);
}

TEST(VolumeRendering, ExtremeDensitiesAndLengthsStayFinite) {
  const float extremes[] = {0.0f, 1e-10f, 1.0f, 1e10f, 1e30f};
  for (const float sigma : extremes) {
    for (const float dt : extremes) {
      RayCase ray;
      ray.Add(sigma, dt);
      ray.Add(1.0f, 0.1f);
      const Result result = Forward(ray);
      for (const float value : {result.rgb[0], result.opacity, result.depth}) {
        EXPECT_TRUE(std::isfinite(value)) << sigma << " " << dt;
      }
      for (const float g : Backward(ray, {1, 1, 1}, 1, 0).sigma) {
        EXPECT_TRUE(std::isfinite(g)) << sigma << " " << dt;
      }
    }
  }
}

TEST(VolumeRendering, InfiniteDensityOverNoLengthIsEmpty) {
  RayCase ray;
  ray.Add(std::numeric_limits<float>::infinity(), 0.0f);
  EXPECT_EQ(Forward(ray).opacity, 0.0f);
  EXPECT_EQ(Backward(ray, {1, 1, 1}, 1, 1).sigma[0], 0.0f);
}

TEST(VolumeRendering, SplittingAnIntervalChangesNothing) {
  RayCase whole, split;
  whole.Add(3.0f, 0.5f);
  split.Add(3.0f, 0.25f);
  split.Add(3.0f, 0.25f);
  const Result a = Forward(whole), b = Forward(split);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.rgb[c], b.rgb[c], 1e-6 * a.rgb[c]);
}

TEST(VolumeRendering, AHomogeneousSlabFollowsBeerAndLambert) {
  RayCase ray;
  constexpr int kSteps = 4096;
  constexpr float kLength = 2.0f, kSigma = 1.7f;
  for (int i = 0; i < kSteps; ++i) ray.Add(kSigma, kLength / kSteps);
  const double T = std::exp(-kSigma * static_cast<double>(kLength));
  const Result result = Forward(ray);
  EXPECT_NEAR(result.rgb[0], 0.5 * (1 - T) + 0.2 * T, 1e-6);
  // The mean of t under sigma e^{-sigma (t-1)} on [1, 1 + L], times the opacity.
  const double depth = (1 - T) * (1 + 1 / kSigma) - kLength * T;
  EXPECT_NEAR(result.depth, depth, 1e-3);
}

TEST(VolumeRendering, GradientsDeepInTheRayKeepTheirSign) {
  RayCase ray;
  for (int i = 0; i < 40; ++i) ray.Add(4.0f, 0.1f, i % 3 == 0 ? 0.9f : 0.1f);
  const long double g[3] = {1, 0, 0};
  const auto oracle = reference::GradientOfSigma(ray.Oracle(), g, 0, 0);
  const Gradients gradients = Backward(ray, {1, 0, 0}, 0, 0);
  ASSERT_LT(reference::TransmittanceBefore(ray.Oracle(), 38), 1e-5);
  for (std::size_t i = 0; i < oracle.size(); ++i) {
    EXPECT_NEAR(gradients.sigma[i], static_cast<double>(oracle[i]),
                1e-4 * static_cast<double>(std::fabs(oracle[i])));
  }
}

// With a radiance of (g, 0, 0) and no background the red of the pixel is the sum of w_i g_i.
TEST(Weights, MatchTheRenderingIntegralInValueAndGradient) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  const std::vector<std::int64_t> begin = {0, 7, 7, 30};
  std::vector<float> sigma(30), dt(30), g(30), radiance(90, 0.0f), weights(30), dL_dsigma(30);
  for (int i = 0; i < 30; ++i) {
    sigma[i] = i == 12 ? std::numeric_limits<float>::infinity() : 5 * uniform(generator);
    dt[i] = i == 5 ? 0.0f : uniform(generator);
    g[i] = uniform(generator) - 0.5f;
    radiance[3 * i] = g[i];
  }
  WeightsForward<float>(begin, sigma, dt, weights, 0, 3);
  WeightsBackward<float>(begin, sigma, dt, g, dL_dsigma, 0, 3);

  const std::vector<float> background(9, 0.0f), zeros(3, 0.0f), ones = {1, 0, 0, 1, 0, 0, 1, 0, 0};
  std::vector<float> rgb(9), opacity(3), depth(3), expected(30), unused(90), unused_background(9);
  const RaySegments<float> in = {begin, sigma, dt, dt, radiance, background};
  CompositeForward<float>(in, {rgb, opacity, depth}, 0, 3);
  CompositeBackward<float>(in, {ones, zeros, zeros}, {expected, unused, unused_background}, 0, 3);
  for (int ray = 0; ray < 3; ++ray) {
    double red = 0, sum = 0;
    for (std::int64_t i = begin[ray]; i < begin[ray + 1]; ++i) {
      red += static_cast<double>(weights[i]) * static_cast<double>(g[i]);
      sum += static_cast<double>(weights[i]);
    }
    EXPECT_NEAR(red, rgb[3 * ray], 1e-6);
    EXPECT_NEAR(sum, opacity[ray], 1e-6);
  }
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(dL_dsigma[i], expected[i], 1e-6) << i;
}

TEST(CountVisible, StopsAtLowTransmittance) {
  const std::vector<std::int64_t> begin = {0, 10, 10, 13};
  const std::vector<float> sigma(13, 2.0f), dt(13, 1.0f);
  std::vector<std::int64_t> kept(3);
  CountVisible<float>(begin, sigma, dt, 1e-3, kept, 0, 3);
  // T before sample i is e^{-2i}: above 1e-3 for i = 0..3.
  EXPECT_EQ(kept, (std::vector<std::int64_t>{4, 0, 3}));
}

}  // namespace
}  // namespace nerf::kernels
