#include "sfm/pair_matching.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sfm/pair_selection.h"
#include "tests/support/colmap_database_file.h"
#include "tests/support/feature_scene.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

using testing::ElementsAre;

class PairMatching : public testing::Test {
 protected:
  void Write(const test::FeatureScene& scene) {
    std::vector<test::DatabaseImage> images;
    for (std::size_t i = 0; i < scene.features.size(); ++i) {
      images.push_back({scene.posed.images[i].name, scene.features[i]});
    }
    test::WriteColmapDatabase(path_, images);
  }

  test::ScratchFolder folder_;
  std::filesystem::path path_ = folder_.path() / "database.db";
};

TEST_F(PairMatching, FindsTheFeaturesOfTheSamePoints) {
  const test::FeatureScene scene({.images = 5});
  Write(scene);
  ColmapDatabase database(path_);
  std::size_t last = 0;
  MatchPairs(database, AllPairs(5), 2, [&](std::size_t done) { last = done; });
  EXPECT_EQ(last, 10u);
  for (const ImagePair& pair : AllPairs(5)) {
    int right = 0, wrong = 0;
    for (const FeatureMatch& match : database.ReadVerified(pair)) {
      const int a = scene.point_of_feature[pair.first][match.first];
      const int b = scene.point_of_feature[pair.second][match.second];
      ++(a == b && a >= 0 ? right : wrong);
    }
    EXPECT_GT(right, 150);
    EXPECT_LE(wrong, 1);
  }
}

// An interrupted call goes on with the pairs that are missing; the numbers of threads do not
// matter.
TEST_F(PairMatching, GoesOnWithTheRemainingPairs) {
  const test::FeatureScene scene({.images = 4, .points = 100});
  Write(scene);
  const auto results = [&] {
    ColmapDatabase database(path_);
    std::vector<std::vector<FeatureMatch>> all;
    for (const ImagePair& pair : AllPairs(4)) all.push_back(database.ReadVerified(pair));
    return all;
  };
  {
    ColmapDatabase database(path_);
    MatchPairs(database, AllPairs(4), 1, [](std::size_t) {});
  }
  const auto at_once = results();
  {
    ColmapDatabase database(path_);
    database.RemoveMatches();
    EXPECT_TRUE(database.MatchedPairs().empty());
    MatchPairs(database, {{0, 1}, {2, 3}}, 3, [](std::size_t) {});
  }
  ColmapDatabase database(path_);
  EXPECT_THAT(database.MatchedPairs(), ElementsAre(ImagePair{0, 1}, ImagePair{2, 3}));
  std::vector<std::size_t> progress;
  MatchPairs(database, AllPairs(4), 3, [&](std::size_t done) { progress.push_back(done); });
  EXPECT_THAT(progress, ElementsAre(6));
  EXPECT_EQ(results(), at_once);
}

// Two places that share no point: photographs 0 to 3 and 4 to 7.
TEST_F(PairMatching, ComparingAllPairsTellsPlacesApart) {
  const test::FeatureScene here({.images = 4}), there({.images = 4, .seed = 2});
  std::vector<test::DatabaseImage> images;
  for (int i = 0; i < 4; ++i) images.push_back({"a" + std::to_string(i), here.features[i]});
  for (int i = 0; i < 4; ++i) images.push_back({"b" + std::to_string(i), there.features[i]});
  test::WriteColmapDatabase(path_, images);
  const ColmapDatabase database(path_);
  int last = 0;
  const auto similar = CompareAllPairs(database, 2, [&](int done) { last = done; });
  EXPECT_EQ(last, 8);
  EXPECT_EQ(similar.size(), 12u);
  for (const auto& [pair, matches] : similar) {
    EXPECT_EQ(pair.first < 4, pair.second < 4);
    EXPECT_GT(matches, 50);
  }
}

TEST(PairSelection, TakesTheBestOfEachPhotographAndItsNeighboursByName) {
  const std::vector<std::pair<ImagePair, int>> pairs = {
      {{0, 1}, 10}, {{0, 2}, 50}, {{0, 3}, 40}, {{1, 2}, 5}, {{1, 3}, 30}};
  EXPECT_THAT(MostSimilarPairs(pairs, 4, 1, 0),
              ElementsAre(ImagePair{0, 2}, ImagePair{0, 3}, ImagePair{1, 3}));
  EXPECT_THAT(MostSimilarPairs(pairs, 4, 0, 1),
              ElementsAre(ImagePair{0, 1}, ImagePair{1, 2}, ImagePair{2, 3}));
  EXPECT_EQ(MostSimilarPairs(pairs, 4, 9, 9), AllPairs(4));
  EXPECT_TRUE(MostSimilarPairs({}, 0, 3, 3).empty());
}

TEST(PairSelection, OfASequenceIsNeighboursAndPowersOfTwo) {
  const auto pairs = SequentialPairs(50, 3);
  const auto partners = std::ranges::count_if(pairs, [](ImagePair p) { return p.first == 10; });
  EXPECT_EQ(partners, 4);  // 11, 12, 13, 14
  EXPECT_TRUE(std::ranges::is_sorted(pairs));
  EXPECT_EQ(SequentialPairs(50, 49), AllPairs(50));
  EXPECT_EQ(AllPairs(1).size(), 0u);
}

TEST(PairsBetween, AreAllOrAsManyAsAllowed) {
  EXPECT_EQ(
      PairsBetween({5, 0}, {1, 2, 3, 4}, 100),
      (std::vector<ImagePair>{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 5}, {2, 5}, {3, 5}, {4, 5}}));
  EXPECT_EQ(PairsBetween({5, 0}, {1, 2, 3, 4}, 4),
            (std::vector<ImagePair>{{0, 1}, {0, 3}, {1, 5}, {3, 5}}));
  EXPECT_TRUE(PairsBetween({}, {1, 2}, 100).empty());
  EXPECT_TRUE(PairsBetween({1, 2}, {}, 100).empty());
  EXPECT_EQ(Joined({{0, 1}, {2, 3}}, {{0, 1}, {1, 2}}),
            (std::vector<ImagePair>{{0, 1}, {1, 2}, {2, 3}}));
}

}  // namespace
}  // namespace nerf::sfm
