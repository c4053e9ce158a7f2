#include "nerf/sampling/ray_intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "nerf/sampling/contraction.h"

namespace nerf {
namespace {

RayBatch OneRay(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float jitter) {
  RayBatch rays;
  rays.Resize(1);
  for (int c = 0; c < 3; ++c) {
    rays.origin[c] = origin[c];
    rays.direction[c] = direction.normalized()[c];
  }
  rays.jitter[0] = jitter;
  return rays;
}

// Length of the way between two distances in contracted space, in small steps.
double ContractedLength(const RayBatch& rays, double from, double to) {
  const Eigen::Vector3f origin(rays.origin.data()), direction(rays.direction.data());
  constexpr int kSteps = 2000;
  double length = 0;
  for (int i = 0; i < kSteps; ++i) {
    // Even in log t: the way is long.
    const double a = from * std::pow(to / from, i / static_cast<double>(kSteps));
    const double b = from * std::pow(to / from, (i + 1) / static_cast<double>(kSteps));
    const auto middle = static_cast<float>(0.5 * (a + b));
    length +=
        (b - a) * static_cast<double>(ContractedSpeed(origin + middle * direction, direction));
  }
  return length;
}

TEST(EqualIntervals, AreOfEqualLengthInContractedSpace) {
  MarchOptions options;
  for (const Eigen::Vector3f& origin :
       {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0.5f, -1.5f, 0.2f), Eigen::Vector3f(3, 1, 0)}) {
    const RayBatch rays = OneRay(origin, Eigen::Vector3f(-0.8f, 0.7f, 0.1f), 0.5f);
    std::vector<float> edges(33);
    EqualIntervals(rays, 0, options, edges);
    EXPECT_EQ(edges.front(), 0.05f);
    EXPECT_EQ(edges.back(), 100.0f);
    EXPECT_TRUE(std::ranges::is_sorted(edges));
    const double mean = ContractedLength(rays, 0.05, 100.0) / 32;
    for (int i = 0; i < 32; ++i) {
      EXPECT_NEAR(ContractedLength(rays, edges[i], edges[i + 1]), mean, 0.15 * mean) << i;
    }
  }
}

TEST(EqualIntervals, JitterShiftsTheInnerEdgesByUpToHalfAnInterval) {
  const Eigen::Vector3f origin(0, 0, 0), direction(1, 0, 0);
  MarchOptions options;
  options.far_distance = 0.9;  // inside the unit ball lengths are lengths
  for (const float jitter : {0.0f, 0.25f, 0.99f}) {
    std::vector<float> edges(11);
    EqualIntervals(OneRay(origin, direction, jitter), 0, options, edges);
    for (int i = 1; i < 10; ++i) {
      EXPECT_NEAR(edges[i], 0.05f + 0.085f * (static_cast<float>(i) + jitter - 0.5f), 1e-5f);
    }
  }
}

TEST(ResampleIntervals, GivesIntervalsOfEqualWeight) {
  const std::vector<float> edges = {0, 1, 2, 4}, weights = {1, 0, 3};
  std::vector<float> out(400);
  ResampleIntervals(edges, weights, 0.0f, 0.5f, out);
  EXPECT_TRUE(std::ranges::is_sorted(out));
  const auto below = [&](float t) {
    return std::ranges::count_if(out, [&](float x) { return x < t; });
  };
  EXPECT_EQ(below(1.0f), 100);
  EXPECT_EQ(below(2.0f), 100) << "nothing where there is no weight";
  EXPECT_EQ(below(3.0f), 250);
  EXPECT_LE(out.back(), 4.0f);
}

TEST(ResampleIntervals, PaddingSamplesEveryInterval) {
  const std::vector<float> edges = {0, 1, 2, 3}, weights = {0, 1, 0};
  std::vector<float> out(600);
  ResampleIntervals(edges, weights, 1.0f, 0.5f, out);
  // A third of the padding of 1 for each interval, against a weight of 1.
  EXPECT_NEAR(static_cast<double>(std::ranges::count_if(out, [](float x) { return x < 1; })), 100,
              1);
}

TEST(ResampleIntervals, WithoutWeightOrWithHugeWeightsStaysInsideTheRay) {
  const std::vector<float> edges = {0.5f, 1, 2, 7};
  for (const std::vector<float>& weights :
       {std::vector<float>{0, 0, 0}, {3e38f, 3e38f, 3e38f}, {1e-45f, 0, 0}, {0, 0, 1e-38f}}) {
    for (const float jitter : {0.0f, 0.999999f}) {
      std::vector<float> out(9);
      ResampleIntervals(edges, weights, 0.01f, jitter, out);
      EXPECT_TRUE(std::ranges::is_sorted(out));
      EXPECT_GE(out.front(), 0.5f);
      EXPECT_LE(out.back(), 7.0f);
    }
  }
}

}  // namespace
}  // namespace nerf
