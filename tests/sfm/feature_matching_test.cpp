#include "sfm/feature_matching.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/feature_scene.h"

namespace nerf::sfm {
namespace {

constexpr int kSize = kernels::kDescriptorSize;

// COLMAP's rule, written down plainly: the index of the match in one direction, or -1.
int MatchOneWay(const Features& from, int i, const Features& to) {
  double best = 0, second = 0;
  int index = -1;
  for (int j = 0; j < to.Count(); ++j) {
    const double product =
        std::inner_product(&from.descriptors[i * kSize], &from.descriptors[i * kSize] + kSize,
                           &to.descriptors[j * kSize], 0.0);
    if (product > best) {
      second = best;
      best = product;
      index = j;
    } else if (product > second) {
      second = product;
    }
  }
  const auto angle = [](double product) { return std::acos(std::min(product / 262144, 1.0)); };
  return index >= 0 && angle(best) <= 0.7 && angle(best) < 0.8 * angle(second) ? index : -1;
}

TEST(MatchFeatures, IsMutualNearestWithARatioTest) {
  const test::FeatureScene scene({.images = 3, .points = 200, .spurious = 0.5});
  for (int other = 1; other < 3; ++other) {
    const Features &a = scene.features[0], &b = scene.features[other];
    std::vector<FeatureMatch> expected;
    for (int i = 0; i < a.Count(); ++i) {
      const int j = MatchOneWay(a, i, b);
      if (j >= 0 && MatchOneWay(b, j, a) == i) {
        expected.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
      }
    }
    EXPECT_GT(expected.size(), 100u);
    EXPECT_EQ(MatchFeatures(a, b), expected);
  }
}

TEST(MatchFeatures, OfNothingIsNothing) {
  const test::FeatureScene scene({.images = 1, .points = 5});
  EXPECT_TRUE(MatchFeatures({}, scene.features[0]).empty());
  EXPECT_TRUE(MatchFeatures(scene.features[0], {}).empty());
}

// A feature that occurs twice cannot be told from its copy.
TEST(MatchFeatures, LeavesOutWhatOccursTwice) {
  Features a = test::FeatureScene({.images = 1, .points = 20, .spurious = 0}).features[0], b = a;
  std::copy_n(&b.descriptors[3 * kSize], kSize, &b.descriptors[11 * kSize]);
  const auto matches = MatchFeatures(a, b);
  EXPECT_EQ(matches.size(), 18u);
  for (const FeatureMatch& match : matches) {
    EXPECT_EQ(match.first, match.second);
    EXPECT_NE(match.first, 3u);
  }
}

TEST(LargestFeatures, KeepsDescriptorsAndPositionsTogether) {
  Features features = test::FeatureScene({.images = 1, .points = 5, .spurious = 0}).features[0];
  features.scales = {1, 5, 2, 5, 3};
  const Features largest = LargestFeatures(features, 3);
  ASSERT_EQ(largest.Count(), 3);
  const int kept[] = {1, 3, 4};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(largest.positions[k], features.positions[kept[k]]);
    EXPECT_TRUE(std::equal(&largest.descriptors[k * kSize], &largest.descriptors[k * kSize] + kSize,
                           &features.descriptors[kept[k] * kSize]));
  }
  EXPECT_EQ(LargestFeatures(features, 99).Count(), 5);
}

}  // namespace
}  // namespace nerf::sfm
