#include "sfm/reconstruction_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>

#include "sfm/pair_selection.h"
#include "tests/support/feature_scene.h"

namespace nerf::sfm {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A true reconstruction, and the matches of its photographs.
class Verdicts : public testing::Test {
 protected:
  Verdicts() {
    for (const ImagePair& pair : AllPairs(static_cast<int>(model_.images.size()))) {
      SeenTwice seen{pair, {}, {}};
      for (std::size_t a = 0; a < scene_.point_of_feature[pair.first].size(); ++a) {
        const int point = scene_.point_of_feature[pair.first][a];
        if (point < 0) continue;
        for (std::size_t b = 0; b < scene_.point_of_feature[pair.second].size(); ++b) {
          if (scene_.point_of_feature[pair.second][b] != point) continue;
          seen.in_first.push_back(scene_.features[pair.first].positions[a].cast<double>());
          seen.in_second.push_back(scene_.features[pair.second].positions[b].cast<double>());
        }
      }
      matches_.push_back(seen);
    }
  }
  ReconstructionVerdict Judge() const { return JudgeReconstruction(model_, matches_); }
  void Turn(int image, double radians) {
    model_.images[image].world_from_camera.rotate(
        Eigen::AngleAxisd(radians, Eigen::Vector3d(1, 2, 0).normalized()));
  }

  test::FeatureScene scene_ = test::FeatureScene({.images = 20, .points = 200});
  PosedImages model_ = scene_.Reconstruction(20);
  std::vector<SeenTwice> matches_;
};

TEST_F(Verdicts, TheTruthIsGood) {
  const ReconstructionVerdict verdict = Judge();
  EXPECT_EQ(verdict.trust, Trust::kGood);
  EXPECT_EQ(verdict.reason, "");
  EXPECT_EQ(verdict.figures.registered, 20);
  EXPECT_GT(verdict.figures.fitting, 0.99);
  EXPECT_GT(verdict.figures.observations, 190);
  EXPECT_THAT(verdict.figures.misplaced, ElementsAre());
  EXPECT_THAT(Describe(verdict), HasSubstr("good: "));
}

TEST_F(Verdicts, AMisplacedPhotographIsFound) {
  Turn(7, 0.15);
  const ReconstructionVerdict verdict = Judge();
  EXPECT_EQ(verdict.trust, Trust::kGood);
  EXPECT_THAT(verdict.figures.misplaced, ElementsAre(7));
  const PosedImages rest = WithoutImages(model_, verdict.figures.misplaced);
  ASSERT_EQ(rest.images.size(), 19u);
  EXPECT_EQ(rest.images[7].name, model_.images[8].name);
  for (const SparsePoint& point : rest.points) {
    EXPECT_GE(point.track.size(), 2u);
    for (const TrackElement& element : point.track) EXPECT_LT(element.image, 19);
  }
  // The sightings of the others stay theirs.
  const TrackElement &before = model_.points[0].track.back(), &after = rest.points[0].track.back();
  EXPECT_EQ(before.pixel, after.pixel);
  EXPECT_EQ(model_.images[before.image].name, rest.images[after.image].name);
}

// As two parts that were joined wrongly: each fits in itself.
TEST_F(Verdicts, TwoPartsThatDoNotFitAreNotGood) {
  const Eigen::Isometry3d moved(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  for (int i = 0; i < 10; ++i) {
    model_.images[i].world_from_camera = moved * model_.images[i].world_from_camera;
  }
  const ReconstructionVerdict verdict = Judge();
  EXPECT_NE(verdict.trust, Trust::kGood);
  EXPECT_THAT(verdict.reason, HasSubstr("misplaced"));
}

TEST_F(Verdicts, WrongPosesAreBroken) {
  for (int i = 0; i < 20; ++i) Turn(i, 0.1 * (i % 5));
  const ReconstructionVerdict verdict = Judge();
  EXPECT_EQ(verdict.trust, Trust::kBroken);
  EXPECT_THAT(Describe(verdict), testing::AllOf(HasSubstr("broken: "), HasSubstr("closer steps")));
}

TEST_F(Verdicts, FewPointsAreDoubtful) {
  model_.points.resize(40);
  const ReconstructionVerdict verdict = Judge();
  EXPECT_EQ(verdict.trust, Trust::kDoubtful);
  EXPECT_THAT(verdict.reason, HasSubstr("texture"));
}

TEST_F(Verdicts, ACameraThatOnlyTurnsIsDoubtful) {
  const test::FeatureScene narrow({.images = 6, .points = 200, .arc = 0.004});
  PosedImages model = narrow.Reconstruction(6);
  matches_.resize(1);
  matches_[0].images = {0, 1};
  matches_[0].in_first.assign(1, narrow.features[0].positions[0].cast<double>());
  matches_[0].in_second = matches_[0].in_first;
  EXPECT_THAT(JudgeReconstruction(model, matches_).reason, HasSubstr("do not only turn"));
}

TEST_F(Verdicts, WithoutMatchesThereIsNothingToJudgeBy) {
  Turn(3, 1);
  EXPECT_EQ(JudgeReconstruction(model_, {}).trust, Trust::kGood);
}

// Each of ten photographs stands two to four degrees from where the other model has it.
TEST_F(Verdicts, AModelThatOthersContradictIsDoubtful) {
  PosedImages bent = model_;
  for (int i = 0; i < 10; ++i) {
    bent.images[i].world_from_camera.rotate(
        Eigen::AngleAxisd(0.035 + 0.002 * i, Eigen::Vector3d(i % 3, 1, i % 2).normalized()));
  }
  PosedImages part = model_;
  part.images.resize(10);
  ReconstructionVerdict verdict;
  JudgeAgreement(bent, {{part}}, verdict);
  EXPECT_EQ(verdict.trust, Trust::kDoubtful);
  EXPECT_GT(verdict.figures.disagreement, 1.5);
  EXPECT_THAT(verdict.reason, HasSubstr("smaller reconstruction"));
}

TEST_F(Verdicts, AModelThatOthersConfirmIsGood) {
  // In another frame and unit; two folders with the same file names.
  for (std::size_t i = 0; i < model_.images.size(); ++i) {
    model_.images[i].name = fmt::format("{}/{}.jpg", i % 2, i / 2);
    model_.images[i].path = model_.images[i].name;
  }
  PosedImages part = model_;
  part.images.resize(10);
  const Eigen::Isometry3d moved(Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()));
  for (PosedImage& image : part.images) {
    image.world_from_camera = moved * image.world_from_camera;
    image.world_from_camera.translation() *= 3;
  }
  ReconstructionVerdict verdict;
  JudgeAgreement(model_, {{part, model_}}, verdict);
  EXPECT_EQ(verdict.trust, Trust::kGood);
  EXPECT_LT(verdict.figures.disagreement, 1e-6);
  // Few shared photographs are no evidence.
  part.images.resize(4);
  part.images[1].world_from_camera.rotate(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()));
  JudgeAgreement(model_, {{part}}, verdict);
  EXPECT_EQ(verdict.trust, Trust::kGood);
}

}  // namespace
}  // namespace nerf::sfm
