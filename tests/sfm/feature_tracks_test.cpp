#include "sfm/feature_tracks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace nerf::sfm {
namespace {

using testing::ElementsAre;
using Matches = std::vector<std::pair<ImagePair, std::vector<FeatureMatch>>>;

TEST(Tracks, JoinMatchesOverSeveralPhotographs) {
  const Matches matches = {{{0, 1}, {{2, 0}, {1, 3}}}, {{1, 2}, {{0, 5}}}, {{2, 3}, {{5, 1}}}};
  const std::vector<int> features = {3, 4, 6, 2};
  EXPECT_THAT(BuildTracks(matches, features, 3),
              ElementsAre(FeatureTrack{{0, 2}, {1, 0}, {2, 5}, {3, 1}}));
  EXPECT_EQ(BuildTracks(matches, features, 2).size(), 2u);
}

// Two features of one photograph cannot both show the point.
TEST(Tracks, LeaveOutPhotographsWithSeveralFeatures) {
  const Matches matches = {
      {{0, 1}, {{0, 0}}}, {{1, 2}, {{0, 0}}}, {{0, 3}, {{0, 0}}}, {{2, 3}, {{0, 1}}}};
  const std::vector<int> features = {1, 1, 1, 2};
  EXPECT_THAT(BuildTracks(matches, features, 2), ElementsAre(FeatureTrack{{0, 0}, {1, 0}, {2, 0}}));
  EXPECT_TRUE(BuildTracks(matches, features, 4).empty());
}

TEST(Tracks, OfNothingAreNone) {
  EXPECT_TRUE(BuildTracks(Matches{}, std::vector<int>{}, 2).empty());
  EXPECT_TRUE(BuildTracks(Matches{}, std::vector<int>{4, 0}, 2).empty());
}

}  // namespace
}  // namespace nerf::sfm
