#include "nerf/effects/inspection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "nerf/image/image_io.h"
#include "nerf/scene/scene_normalization.h"
#include "nerf/synthetic/sample_folder.h"
#include "sfm/colmap_model.h"
#include "sfm/masks.h"
#include "sfm/transforms_json.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using synthetic::Scenario;

synthetic::SampleOptions Small(Scenario scenario) {
  synthetic::SampleOptions options;
  options.scenario = scenario;
  options.views = synthetic::DefaultViewCount(scenario);
  options.width = 240;
  options.height = 180;
  options.samples_per_pixel = 4;
  options.seed = 5;
  return options;
}

struct Case {
  Scenario scenario;
  std::string name, calls_for;  // the effects, sorted
};

class EachScenario : public testing::TestWithParam<Case> {};

// Inspect turns on the effects that a capture calls for, and no others.
TEST_P(EachScenario, IsJudgedCorrectly) {
  const test::ScratchFolder folder;
  synthetic::WriteSample(folder.path(), Small(GetParam().scenario));
  PosedImages posed =
      sfm::ReadColmapModel(folder.path() / "truth" / "sparse", folder.path() / "images");
  sfm::FindMasks(posed);
  const Inspection inspection = Inspect(posed);
  SCOPED_TRACE(TableOf(inspection.verdicts));
  std::set<std::string> on;
  for (const Verdict& verdict : inspection.verdicts) {
    EXPECT_TRUE(verdict.decided) << verdict.effect;
    if (verdict.on && verdict.effect != "near") on.insert(verdict.effect);
  }
  std::string names;
  for (const std::string& name : on) names += (names.empty() ? "" : ",") + name;
  EXPECT_EQ(names, GetParam().calls_for);
}

std::string NameOf(const testing::TestParamInfo<Case>& of) { return of.param.name; }

INSTANTIATE_TEST_SUITE_P(
    Inspect, EachScenario,
    testing::Values(Case{Scenario::kNothing, "Nothing", "unbounded"},
                    Case{Scenario::kViewDependence, "View", "unbounded,view_dependence"},
                    Case{Scenario::kBackground, "Background", "background"},
                    Case{Scenario::kUnbounded, "Unbounded", "unbounded"},
                    Case{Scenario::kExposure, "Exposure", "exposure,unbounded"},
                    Case{Scenario::kMasks, "Masks", "masks,unbounded"},
                    Case{Scenario::kAlpha, "Alpha", "alpha"},
                    Case{Scenario::kRobust, "Robust", "robust,unbounded"},
                    Case{Scenario::kDepthSupervision, "Depth", "depth_supervision,unbounded"},
                    Case{Scenario::kHdr, "Hdr", "hdr,unbounded"},
                    Case{Scenario::kPoseRefinement, "Poses", "pose_refinement,unbounded"},
                    Case{Scenario::kAntiAliasing, "Footprint", "alpha,anti_aliasing"}),
    NameOf);

TEST(Inspect, FindsTheExposuresThatASampleWasTakenWith) {
  const test::ScratchFolder folder;
  const synthetic::SampleOptions options = Small(Scenario::kExposure);
  synthetic::WriteSample(folder.path(), options);
  const PosedImages posed =
      sfm::ReadColmapModel(folder.path() / "truth" / "sparse", folder.path() / "images");
  const Inspection inspection = Inspect(posed);
  ASSERT_EQ(inspection.stops.size(), posed.images.size());
  std::vector<double> truth;
  double mean = 0;
  for (int i = 0; i < static_cast<int>(posed.images.size()); ++i) {
    const auto gain = synthetic::PhotoSettingsFor(options.scenario, i, options.seed,
                                                  posed.images[i].world_from_camera)
                          .gain;
    truth.push_back(gain.array().log().mean() / std::log(2.0));
    mean += truth.back() / static_cast<double>(posed.images.size());
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(inspection.stops[i], truth[i] - mean, 0.1) << posed.images[i].name;
  }
}

TEST(Inspect, PutsTheNearPlaneInFrontOfEverySurface) {
  const test::ScratchFolder folder;
  synthetic::WriteSample(folder.path(), Small(Scenario::kNothing));
  const PosedImages posed =
      sfm::ReadColmapModel(folder.path() / "truth" / "sparse", folder.path() / "images");
  double nearest = 1e9;
  for (const PosedImage& image : posed.images) {
    const std::string stem = image.name.substr(0, image.name.find('.'));
    for (const float depth :
         ReadImage(folder.path() / "truth" / (stem + ".depth.exr"), false).pixels) {
      if (depth > 0) nearest = std::min(nearest, static_cast<double>(depth));
    }
  }
  for (const Verdict& verdict : Inspect(posed).verdicts) {
    if (verdict.effect != "near") continue;
    EXPECT_LT(verdict.figure, nearest * NormalizeScene(posed).scale);
    EXPECT_GT(verdict.figure, 0.3 * nearest * NormalizeScene(posed).scale);
    EXPECT_EQ(verdict.assignment.find("march.near_distance=0."), 0u);
    return;
  }
  FAIL() << "no verdict on the near plane";
}

TEST(Inspect, WithoutALearnedBackgroundKeepsDistantPointsInContractedSpace) {
  const test::ScratchFolder folder;
  synthetic::WriteSample(folder.path(), Small(Scenario::kBackground));
  const PosedImages posed =
      sfm::ReadColmapModel(folder.path() / "truth" / "sparse", folder.path() / "images");
  for (const bool learned : {true, false}) {
    const Inspection inspection = Inspect(posed, {}, learned);
    const auto unbounded = std::ranges::find(inspection.verdicts, "unbounded", &Verdict::effect);
    ASSERT_NE(unbounded, inspection.verdicts.end());
    EXPECT_EQ(unbounded->on, !learned);
    const bool fitted = inspection.normalized_from_world.scale != NormalizeScene(posed).scale;
    EXPECT_EQ(fitted, learned);
  }
}

TEST(Inspect, WithoutSparsePointsOnlyFactsAreDecided) {
  const test::ScratchFolder folder;
  synthetic::WriteSample(folder.path(), Small(Scenario::kAlpha));
  const Inspection inspection =
      Inspect(sfm::ReadTransformsJson(folder.path() / "truth" / "transforms.json"));
  std::map<std::string, bool> decided;
  for (const Verdict& verdict : inspection.verdicts) decided[verdict.effect] = verdict.decided;
  EXPECT_TRUE(decided.at("alpha"));
  EXPECT_FALSE(decided.at("view_dependence"));
  EXPECT_FALSE(decided.at("exposure"));
}

TEST(Verdict, IsMoreConclusiveFurtherFromItsThreshold) {
  Verdict verdict;
  verdict.decided = true;
  verdict.threshold = 0.1;
  verdict.figure = 0.1;
  EXPECT_EQ(verdict.Confidence(), 0);
  verdict.figure = 0.2;
  EXPECT_EQ(verdict.Confidence(), 1);
  verdict.figure = 0.01;
  EXPECT_EQ(verdict.Confidence(), 1);
  verdict.decided = false;
  EXPECT_EQ(verdict.Confidence(), 0);
}

}  // namespace
}  // namespace nerf
