#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "sfm/colmap_program.h"
#include "sfm/pair_selection.h"
#include "sfm/pose_input.h"
#include "tests/support/colmap_database_file.h"
#include "tests/support/colmap_run.h"
#include "tests/support/feature_scene.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::WritePhoto;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Matching : public nerf::test::ColmapRun {
 protected:
  // Photographs around one place, of which the fake COLMAP finds the features, and registers the
  // first.
  //   misplaced  one that is turned; -1: all but every third
  void WriteScene(int count, int registered, int misplaced = -2) {
    const test::FeatureScene scene(
        {.images = count, .points = 300, .opaque = true, .arc = 2 * std::numbers::pi / count});
    std::vector<test::DatabaseImage> images;
    for (int i = 0; i < count; ++i) {
      const std::string& name = scene.posed.images[i].name;
      WritePhoto(photos_.path() / name, 640, 480);
      images.push_back({name, scene.features[i]});
    }
    fake_.SetFeatures(images);
    PosedImages model = scene.Reconstruction(registered);
    for (int i = 0; i < registered; ++i) {
      if (i != misplaced && !(misplaced == -1 && i % 3 != 0)) continue;
      model.images[i].world_from_camera.rotate(
          Eigen::AngleAxisd(0.1 + 0.01 * i, Eigen::Vector3d(1, 1, 0).normalized()));
    }
    fake_.SetModel(model);
  }
  ColmapDatabase Matched() const { return ColmapDatabase(Workspace() / "database.db"); }
};

TEST_F(Matching, ManyNumberedPhotosAreMatchedInSequence) {
  for (int i = 0; i < 101; ++i) {
    WritePhoto(photos_.path() / fmt::format("p{:03}.png", i), 16, 12);
  }
  std::vector<test::DatabaseImage> images;
  for (int i = 0; i < 101; ++i) images.push_back({fmt::format("p{:03}.png", i)});
  fake_.SetFeatures(images);
  fake_.Set("size", "16 12");
  fake_.Set("models", "0 101\n");
  Run();
  const auto pairs = Matched().MatchedPairs();
  EXPECT_EQ(std::vector(pairs.begin(), pairs.end()), SequentialPairs(101, 20));
}

TEST_F(Matching, FewPhotosAreAllMatched) {
  WriteScene(6, 6);
  Run();
  EXPECT_EQ(Matched().MatchedPairs().size(), 15u);
  EXPECT_THAT(fake_.Commands(), ElementsAre("feature_extractor", "mapper"));
}

TEST_F(Matching, GuidedTakesTheMostSimilarPairsAndNeighbours) {
  WriteScene(30, 30);
  Run();
  const auto pairs = Matched().MatchedPairs();
  EXPECT_LT(pairs.size(), 30u * 29 / 2);
  EXPECT_TRUE(pairs.contains({0, 1}));
  EXPECT_TRUE(pairs.contains({0, 29}));  // neighbours around the place, not by name
  EXPECT_FALSE(pairs.contains({0, 15}));
  EXPECT_GE(Matched().VerifiedPairs().size(), 100u);
}

TEST_F(Matching, AllPairsFollowWhereTooFewPhotosAreRegistered) {
  WriteScene(30, 20);
  Run();
  EXPECT_THAT(log_.Text(), HasSubstr("20 of 30 registered; matching the remaining pairs"));
  EXPECT_THAT(log_.Text(), HasSubstr("20 of 30 registered; trying again with more and finer"));
  EXPECT_THAT(fake_.Commands(),
              ElementsAre("feature_extractor", "mapper", "mapper", "feature_extractor", "mapper"));
  EXPECT_THAT(fake_.Calls()[3], HasSubstr("--SiftExtraction.first_octave -1"));
  EXPECT_EQ(Matched().MatchedPairs().size(), 30u * 29 / 2);
  fake_.ForgetCalls();
  Run();
  EXPECT_THAT(fake_.Commands(), IsEmpty());
}

// Photograph 7 is turned by a tenth of a radian: its matches contradict its pose.
TEST_F(Matching, AMisplacedPhotographIsLeftOut) {
  WriteScene(20, 20, 7);
  const PosedImages posed = Run();
  ASSERT_EQ(posed.images.size(), 19u);
  EXPECT_EQ(report_.misplaced, 1);
  EXPECT_EQ(report_.verdict.trust, Trust::kGood);
  EXPECT_THAT(report_.unregistered, ElementsAre("p107.png"));
  EXPECT_THAT(log_.Text(), HasSubstr("1 photographs that COLMAP registered are left out"));
  // So it is for nerf train WORKSPACE.
  EXPECT_EQ(ReadPosedInput(FindInput(Workspace())).images.size(), 19u);
}

// All poses are wrong; with lower thresholds, too.
TEST_F(Matching, ABrokenReconstructionIsSaid) {
  WriteScene(20, 20, -1);
  Run();
  EXPECT_EQ(report_.verdict.trust, Trust::kBroken);
  EXPECT_THAT(log_.Text(), HasSubstr("20 of 20 registered, broken; mapping again with lower"));
  EXPECT_THAT(log_.Text(), HasSubstr("the poses are broken: only"));
  EXPECT_THAT(fake_.Calls().back(), HasSubstr("--Mapper.init_min_num_inliers 50"));
}

// Names with spaces, which COLMAP's own lists of pairs cannot have.
TEST_F(Matching, NamesMayContainSpaces) {
  for (int i = 0; i < 30; ++i) {
    WritePhoto(photos_.path() / fmt::format("p {:03}.png", i), 64, 48);
  }
  fake_.Set("models", "0 30\n");
  EXPECT_EQ(Run().images.size(), 30u);
  EXPECT_THAT(log_.Text(), Not(HasSubstr("warning")));
}

// The matcher of the installed COLMAP searches approximately, so that it misses few.
TEST(MatchingForReal, FindsTheMatchesOfColmap) {
  const test::ScratchFolder photos, out;
  const std::vector<std::string> names = {"0001.jpg", "0002.jpg", "0004.jpg", "0006.jpg"};
  for (const std::string& name : names) {
    fs::create_symlink(fs::absolute(fs::path(NERF_TEST_DATA) / "fox/images" / name),
                       photos.path() / name);
  }
  ColmapOptions options;
  options.max_image_size = 640;
  PosesFromPhotos(photos.path(), out.path(), options);
  const fs::path ours = out.path() / "database.db", theirs = out.path() / "theirs.db";
  fs::copy_file(ours, theirs);
  ColmapDatabase(theirs).RemoveMatches();
  ColmapProgram colmap = ColmapProgram::Find();
  std::vector<std::string> arguments = {"--database_path", theirs.string()};
  const std::string gpu =
      colmap.KnownOption("exhaustive_matcher", {"SiftMatching.use_gpu", "FeatureMatching.use_gpu"});
  arguments.insert(arguments.end(), {"--" + gpu, "0"});
  ASSERT_EQ(
      colmap.Run("exhaustive_matcher", arguments, out.path() / "log.txt", [](auto) {}).exit_code,
      0);
  std::size_t of_ours = 0, of_theirs = 0, both = 0;
  const ColmapDatabase our_database(ours), their_database(theirs);
  for (const ImagePair& pair : AllPairs(static_cast<int>(names.size()))) {
    const auto a = our_database.ReadMatches(pair), b = their_database.ReadMatches(pair);
    of_ours += a.size();
    of_theirs += b.size();
    both += std::ranges::count_if(
        a, [&](const FeatureMatch& match) { return std::ranges::count(b, match) > 0; });
  }
  EXPECT_GT(of_ours, 1000u);
  EXPECT_GE(both, 0.97 * of_ours);
  EXPECT_GE(both, 0.97 * of_theirs);
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
