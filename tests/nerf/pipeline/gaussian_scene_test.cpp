#include "nerf/pipeline/gaussian_scene.h"

#include <gtest/gtest.h>

namespace nerf {
namespace {

Dataset PhotographsOf(int width, int height) {
  Dataset data;
  data.train.resize(1);
  data.train.front().camera.width = width;
  data.train.front().camera.height = height;
  return data;
}

TEST(SplatOptionsFor, NumberGrowsWithPhotographsAndTime) {
  const SplatOptions options;
  const auto count = [&](int width, int height, double seconds) {
    return SplatOptionsFor(options, PhotographsOf(width, height), seconds).count;
  };
  EXPECT_EQ(count(270, 480, 40), 50000);
  EXPECT_EQ(count(270, 480, 600), 50000);
  EXPECT_EQ(count(800, 800, 40), 100000);   // as their side
  EXPECT_EQ(count(800, 800, 600), 200000);  // as their pixels
  EXPECT_EQ(count(800, 800, 0), 200000);    // by iterations
  EXPECT_EQ(count(4000, 4000, 600), 200000);
  EXPECT_GT(count(800, 800, 80), 100000);
  EXPECT_LT(count(800, 800, 80), 200000);
}

TEST(SplatOptionsFor, LowResolutionsTakeLongerForLargePhotographs) {
  const SplatOptions options;
  const SplatOptions same = SplatOptionsFor(options, PhotographsOf(200, 200), 0);
  EXPECT_EQ(same.quarter_resolution, options.quarter_resolution);
  EXPECT_EQ(same.half_resolution, options.half_resolution);
  const SplatOptions large = SplatOptionsFor(options, PhotographsOf(800, 800), 0);
  EXPECT_NEAR(large.quarter_resolution, 1 - 0.75 / std::sqrt(2), 1e-9);
  EXPECT_NEAR(large.half_resolution, 1 - 0.3 / std::sqrt(2), 1e-9);
}

TEST(SplatOptionsFor, AGivenNumberLeavesAllAsItIs) {
  SplatOptions options;
  options.count = 1234;
  const SplatOptions result = SplatOptionsFor(options, PhotographsOf(800, 800), 0);
  EXPECT_EQ(result.count, 1234);
  EXPECT_EQ(result.quarter_resolution, options.quarter_resolution);
  // What was chosen once is not changed again.
  const SplatOptions chosen = SplatOptionsFor(SplatOptions(), PhotographsOf(800, 800), 0);
  EXPECT_EQ(SplatOptionsFor(chosen, PhotographsOf(800, 800), 0).half_resolution,
            chosen.half_resolution);
}

}  // namespace
}  // namespace nerf
