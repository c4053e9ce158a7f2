#include "nerf/pipeline/representation_training.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "nerf/base/stopwatch.h"
#include "nerf/model/run_folder.h"
#include "nerf/scene/scene_normalization.h"
#include "tests/support/input_error_of.h"
#include "tests/support/representation_training.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::CaptureWithValidation;
using test::ConfigOf;
using test::ExpectSameTensors;
using test::never_stop;
using test::Resume;
using test::Train;
using testing::HasSubstr;

TEST(RepresentationTraining, AFieldIsNotTouchedByWhatIsMadeBesideIt) {
  const test::SmallCapture small = CaptureWithValidation();
  test::ScratchFolder field, automatic, splats;
  EXPECT_TRUE(Train(small, ConfigOf(Representation::kField), field.path()).finished);
  EXPECT_TRUE(Train(small, ConfigOf(Representation::kAuto), automatic.path()).finished);
  EXPECT_TRUE(Train(small, ConfigOf(Representation::kSplats), splats.path()).finished);
  ExpectSameTensors(CheckpointPath(field.path()), CheckpointPath(automatic.path()));
  ExpectSameTensors(CheckpointPath(field.path()), CheckpointPath(splats.path()));
  EXPECT_FALSE(fs::exists(GaussiansPath(field.path())));
  EXPECT_FALSE(fs::exists(RepresentationPath(field.path())));
  EXPECT_TRUE(ReadRepresentation(automatic.path()).tried);
  EXPECT_FALSE(ReadRepresentation(splats.path()).tried);
  EXPECT_TRUE(fs::exists(GaussiansPath(splats.path())));
}

TEST(RepresentationTraining, StopsWhileSurfacesAreRendered) {
  const test::SmallCapture small = CaptureWithValidation();
  test::ScratchFolder run;
  std::atomic<bool> stop = false;
  std::size_t rendered = 0;
  const auto listener = [&](const PipelineEvent& event) {
    const auto* surfaces = std::get_if<SurfacesRendered>(&event);
    if (!surfaces) return;
    rendered = surfaces->done;
    stop = true;
  };
  EXPECT_FALSE(
      Train(small, ConfigOf(Representation::kSplats), run.path(), stop, listener).finished);
  EXPECT_EQ(rendered, 1);
  EXPECT_FALSE(fs::exists(GaussiansPath(run.path())));
}

TEST(RepresentationTraining, AFieldGetsTheTimeOfGaussiansThatCannotBeMade) {
  const test::SmallCapture small = CaptureWithValidation();
  Config config = ConfigOf(Representation::kAuto);
  config.train.time_budget = 4;
  config.splats.mean_rate = 3e38;
  test::ScratchFolder run;
  RepresentationRecord decided;
  decided.makes_splats = true;
  decided.field_seconds = 0.5;
  WriteRepresentation(decided, run.path());
  std::string warning;
  const Stopwatch watch;
  const auto listener = [&](const PipelineEvent& event) {
    if (const auto* failed = std::get_if<GaussiansFailed>(&event)) warning = failed->why;
  };
  const RepresentationsTrained trained = Train(small, config, run.path(), never_stop, listener);
  EXPECT_TRUE(trained.finished);
  EXPECT_THAT(warning, HasSubstr("the loss of iteration"));
  EXPECT_GT(watch.Seconds(), 3);
  EXPECT_FALSE(fs::exists(GaussiansPath(run.path())));
  EXPECT_EQ(ReadRepresentation(run.path()).makes_splats, false);
}

// Nothing compares them, but they were asked for.
TEST(RepresentationTraining, GaussiansThatWereAskedForStandWithoutValidation) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 48, 36);
  test::ScratchFolder run;
  EXPECT_TRUE(Train(small, ConfigOf(Representation::kSplats), run.path()).finished);
  EXPECT_EQ(ReadRepresentation(run.path()).Best(), Representation::kSplats);
  EXPECT_TRUE(Resume(small, run.path()).finished);
  EXPECT_EQ(ReadRepresentation(run.path()).Best(), Representation::kSplats);
}

TEST(RepresentationTraining, WithoutValidationTheFieldIsTrainedAlone) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 32, 24);
  test::ScratchFolder run;
  std::string why_not;
  const auto listener = [&](const PipelineEvent& event) {
    if (const auto* decided = std::get_if<RepresentationDecided>(&event)) {
      why_not = decided->why_not;
    }
  };
  EXPECT_TRUE(
      Train(small, ConfigOf(Representation::kAuto), run.path(), never_stop, listener).finished);
  EXPECT_THAT(why_not, HasSubstr("without validation photographs"));
  EXPECT_FALSE(fs::exists(GaussiansPath(run.path())));
  EXPECT_EQ(ReadRepresentation(run.path()).Best(), Representation::kField);
}

// Row 48 of the hard cases. Normalisation cancels units and origin, but for the rounding of poses.
TEST(RepresentationTraining, AMillimetreAndTenKilometresGiveTheSameGaussians) {
  const auto psnr_at = [](double scale, const Eigen::Vector3d& origin) {
    test::SmallCapture small = CaptureWithValidation();
    std::vector<View*> views;
    for (View& view : small.data.train) views.push_back(&view);
    for (View& view : small.data.validation) views.push_back(&view);
    for (PosedImage& image : small.capture.posed.images) {
      image.world_from_camera.translation() =
          scale * image.world_from_camera.translation() + origin;
    }
    small.scene.normalized_from_world = NormalizeScene(small.capture.posed);
    std::size_t next = 0;
    for (const PosedImage& image : small.capture.posed.images) {
      if (image.split != Split::kTrain) continue;
      views[next++]->normalized_from_camera =
          small.scene.normalized_from_world.NormalizedFromCamera(image.world_from_camera);
    }
    test::ScratchFolder run;
    return Train(small, ConfigOf(Representation::kSplats), run.path()).record.reached->splats;
  };
  const double usual = psnr_at(1, Eigen::Vector3d::Zero());
  EXPECT_GT(usual, 13);
  // The built-in scene is about four units across; the origin is that of a UTM zone.
  EXPECT_NEAR(psnr_at(0.25e-3, Eigen::Vector3d::Zero()), usual, 0.3);
  EXPECT_NEAR(psnr_at(0.25e4, {5e5, 5.2e6, 300}), usual, 0.3);
}

// Row 50 of the hard cases.
TEST(RepresentationTraining, MoreGaussiansThanMemoryHoldsAreRefusedWithTheirNumber) {
  const test::SmallCapture small = CaptureWithValidation();
  const Config config = ConfigOf(Representation::kSplats);
  GaussianScene scene = GaussianSceneOf(MakeModel(config, small.scene), small.data, 0);
  scene.config.splats.count = 2000000000;
  const auto field = ModelSnapshot::Copy(MakeModel(config, small.scene), 0);
  EXPECT_THAT(
      test::InputErrorOf([&] { StartAtSurfaces(*field, scene, never_stop, [](std::size_t) {}); }),
      HasSubstr("splats.count 2000000000: the fit needs about"));
}

TEST(RepresentationTraining, LinearPhotographsAreRefusedWhereGaussiansAreAskedFor) {
  test::SmallCapture small = CaptureWithValidation();
  small.data.encoding = ColorEncoding::kLinear;
  test::ScratchFolder run;
  EXPECT_THAT(
      test::InputErrorOf([&] { Train(small, ConfigOf(Representation::kSplats), run.path()); }),
      HasSubstr("linear photographs; or use field"));
}

TEST(RepresentationTraining, ATargetThatTheFieldReachesEndsBoth) {
  const test::SmallCapture small = CaptureWithValidation();
  Config config = ConfigOf(Representation::kSplats);
  config.train.target_psnr = 1;
  test::ScratchFolder run;
  const RepresentationsTrained trained = Train(small, config, run.path());
  EXPECT_TRUE(trained.finished);
  EXPECT_TRUE(trained.field.reached_target);
  EXPECT_FALSE(fs::exists(GaussiansPath(run.path())));
}

}  // namespace
}  // namespace nerf
