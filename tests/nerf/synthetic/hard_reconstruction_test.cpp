// Structure from motion of generated captures, with the installed COLMAP, against the true poses.
#include <gtest/gtest.h>

#include <optional>

#include "nerf/base/input_error.h"
#include "nerf/synthetic/sample_folder.h"
#include "sfm/colmap_runner.h"
#include "sfm/pose_error.h"
#include "sfm/transforms_json.h"
#include "tests/support/scratch_folder.h"

namespace nerf::synthetic {
namespace {

struct Case {
  Scenario scenario;
  std::optional<bool> good;  // whether the poses can be found; nothing: by a hair
};

class HardReconstructionForReal : public testing::TestWithParam<Case> {};

// What is called good is: half of the photographs are turned by less than half a degree from the
// truth.
TEST_P(HardReconstructionForReal, IsJudgedRight) {
  const test::ScratchFolder folder;
  SampleOptions options;
  options.scenario = GetParam().scenario;
  options.samples_per_pixel = options.scenario == Scenario::kMotionBlur ? 9 : 2;
  WriteSample(folder.path(), options);
  sfm::ColmapReport report;
  PosedImages found;
  try {
    found = sfm::PosesFromPhotos(folder.path() / "images", folder.path() / "colmap", {}, &report);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("registered only"), std::string::npos) << error.what();
    EXPECT_FALSE(GetParam().good.value_or(false));
    return;
  }
  if (GetParam().good) {
    EXPECT_EQ(report.verdict.trust == sfm::Trust::kGood, *GetParam().good)
        << sfm::Describe(report.verdict);
  }
  if (report.verdict.trust != sfm::Trust::kGood) return;
  const PosedImages truth = sfm::ReadTransformsJson(folder.path() / "truth" / "transforms.json");
  const sfm::PoseErrors errors = sfm::ComparePoses(found, truth);
  EXPECT_LT(errors.rotation_median, 0.5);
  EXPECT_GE(errors.images, 30);
}

INSTANTIATE_TEST_SUITE_P(
    Scenarios, HardReconstructionForReal,
    testing::Values(Case{Scenario::kViewDependence, true}, Case{Scenario::kTwoGroups, true},
                    Case{Scenario::kMotionBlur, true}, Case{Scenario::kRepeated, std::nullopt},
                    Case{Scenario::kMirrors, false}, Case{Scenario::kTextureless, false}));

}  // namespace
}  // namespace nerf::synthetic
