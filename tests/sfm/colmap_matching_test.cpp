#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/colmap_database_file.h"
#include "tests/support/colmap_run.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::WriteColmapDatabase;
using nerf::test::WritePhoto;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class SequentialMatching : public nerf::test::ColmapRun {};

TEST_F(SequentialMatching, ManyNumberedPhotosAreMatchedInSequence) {
  for (int i = 0; i < 101; ++i) {
    WritePhoto(photos_.path() / fmt::format("p{:03}.png", i), 16, 12);
  }
  fake_.Set("size", "16 12");
  fake_.Set("models", "0 101\n");
  Run();
  EXPECT_THAT(fake_.Calls()[1],
              AllOf(HasSubstr("sequential_matcher"), HasSubstr("--SequentialMatching.overlap 20")));
}

// From COLMAP 3.11 on, pairs at quadratic distances are matched instead of neighbours.
TEST_F(SequentialMatching, NeighboursAndQuadraticDistancesAreTwoPasses) {
  WritePhotos(6);
  fake_.Set("help",
            "--FeatureMatching.use_gpu arg\n--SequentialMatching.overlap arg\n"
            "--SequentialMatching.quadratic_overlap arg\n");
  fake_.Set("models", "0 6\n");
  options_.matcher = "sequential";
  Run();
  EXPECT_THAT(fake_.Calls()[1], HasSubstr("--SequentialMatching.quadratic_overlap 0"));
  EXPECT_THAT(fake_.Calls()[2], HasSubstr("--SequentialMatching.quadratic_overlap 1"));
}

class GuidedMatching : public nerf::test::ColmapRun {
 protected:
  // The matches of the fake COLMAP: none but between the first and the last.
  void FindFeatures(int count) {
    std::vector<nerf::test::DatabaseImage> images;
    for (int i = 0; i < count; ++i) images.push_back({fmt::format("p{:03}.png", i), {1, 2, 3}});
    WriteColmapDatabase(out_.path() / "prepared.db", images, {{0, count - 1, 90}});
    const std::string prepared = (out_.path() / "prepared.db").string();
    fake_.Set("do_feature_extractor", "cp '" + prepared + "' \"$database\"\n");
    // Coarse matches are written to the copy, from which those of the original were removed.
    fake_.Set("do_exhaustive_matcher", "cp '" + prepared + "' \"$database\"\n");
    fake_.Set("do_matches_importer",
              "cat \"$(dirname \"$database\")/pairs.txt\" >> \"$here/pairs\"\n");
  }
};

TEST_F(GuidedMatching, MatchesTheMostSimilarPairsAndNeighbours) {
  WritePhotos(30);
  fake_.Set("models", "0 30\n");
  FindFeatures(30);
  Run();
  std::vector<std::string> commands = fake_.Commands();
  commands.erase(std::unique(commands.begin(), commands.end()), commands.end());
  EXPECT_THAT(commands,
              ElementsAre("feature_extractor", "exhaustive_matcher", "matches_importer", "mapper"));
  EXPECT_THAT(fake_.Calls()[1], HasSubstr("coarse.db"));
  const std::string pairs = fake_.Get("pairs");
  EXPECT_EQ(std::ranges::count(pairs, '\n'), 29 + 28 + 1);
  EXPECT_THAT(pairs, AllOf(HasSubstr("p000.png p029.png\n"), HasSubstr("p010.png p012.png\n"),
                           Not(HasSubstr("p010.png p013.png\n"))));
  EXPECT_FALSE(fs::exists(Workspace() / "coarse.db"));
  EXPECT_FALSE(fs::exists(Workspace() / "pairs.txt"));
}

TEST_F(GuidedMatching, MatchesAllPairsWhereTooFewPhotosAreRegistered) {
  WritePhotos(30);
  fake_.Set("models", "0 20\n");
  FindFeatures(30);
  Run();
  EXPECT_THAT(log_.Text(), HasSubstr("20 of 30 registered; matching the remaining pairs"));
  EXPECT_EQ(fake_.Commands().back(), "mapper");
  EXPECT_THAT(fake_.Calls()[fake_.Calls().size() - 2],
              AllOf(HasSubstr("exhaustive_matcher"), HasSubstr("database.db")));
  fake_.ForgetCalls();
  Run();
  EXPECT_THAT(fake_.Commands(), IsEmpty());
}

TEST_F(GuidedMatching, ListsCannotContainNamesWithSpaces) {
  WritePhotos(30);
  fs::rename(photos_.path() / "p007.png", photos_.path() / "p 007.png");
  fake_.Set("models", "0 30\n");
  Run();
  EXPECT_THAT(fake_.Commands(), ElementsAre("feature_extractor", "exhaustive_matcher", "mapper"));
  EXPECT_THAT(log_.Text(), HasSubstr("p 007.png: guided matching"));
}

TEST(NumberedSequence, IsOneTextAroundNumbersOfOneWidth) {
  EXPECT_TRUE(IsNumberedSequence({"0001.jpg", "0002.jpg", "0004.jpg"}));
  EXPECT_TRUE(IsNumberedSequence({"v2_frame_08.png", "v2_frame_09.png", "v2_frame_10.png"}));
  EXPECT_FALSE(IsNumberedSequence({"frame_10.png", "frame_8.png", "frame_9.png"}));
  EXPECT_FALSE(IsNumberedSequence({"a1.jpg", "b2.jpg"}));
  EXPECT_FALSE(IsNumberedSequence({"01.jpg", "02.png"}));
  EXPECT_FALSE(IsNumberedSequence({"front.jpg", "left.jpg"}));
  EXPECT_FALSE(IsNumberedSequence({"0001.jpg", "0002.jpg", "0900.jpg"}));
  EXPECT_FALSE(IsNumberedSequence({"1234567890123456789012345.jpg", "2.jpg"}));
  EXPECT_FALSE(IsNumberedSequence({}));
}

}  // namespace
}  // namespace nerf::sfm
