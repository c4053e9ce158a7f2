#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "nerf/model/run_folder.h"
#include "nerf/splats/initial_gaussians.h"
#include "tests/support/input_error_of.h"
#include "tests/support/representation_training.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::CaptureWithValidation;
using test::ConfigOf;
using test::ExpectSameTensors;
using test::Resume;
using test::Train;
using test::TrainUntil;
using testing::HasSubstr;

TEST(RepresentationTraining, AFitThatWasStoppedEndsInTheSameBits) {
  const test::SmallCapture small = CaptureWithValidation();
  const Config config = ConfigOf(Representation::kSplats);
  test::ScratchFolder whole, stopped;
  const RepresentationsTrained uninterrupted = Train(small, config, whole.path());
  std::atomic<bool> stop = false;
  const auto listener = [&](const PipelineEvent& event) {
    const auto* step = std::get_if<GaussiansStepped>(&event);
    if (step && step->step == 41) stop = true;
  };
  EXPECT_FALSE(Train(small, config, stopped.path(), stop, listener).finished);
  EXPECT_EQ(OpenGaussians(stopped.path())->Step(), 41);
  EXPECT_FALSE(ReadRepresentation(stopped.path()).reached);
  const RepresentationsTrained resumed = Resume(small, stopped.path());
  EXPECT_TRUE(resumed.finished);
  ExpectSameTensors(GaussiansPath(whole.path()), GaussiansPath(stopped.path()));
  ASSERT_TRUE(resumed.record.reached && uninterrupted.record.reached);
  EXPECT_EQ(resumed.record.reached->splats, uninterrupted.record.reached->splats);
  // A run that has ended is not fitted again, but compared where that is missing.
  RepresentationRecord record = ReadRepresentation(stopped.path());
  record.reached.reset();
  WriteRepresentation(record, stopped.path());
  EXPECT_TRUE(Resume(small, stopped.path()).finished);
  ASSERT_TRUE(ReadRepresentation(stopped.path()).reached);
  EXPECT_EQ(ReadRepresentation(stopped.path()).reached->splats,
            uninterrupted.record.reached->splats);
  ExpectSameTensors(GaussiansPath(whole.path()), GaussiansPath(stopped.path()));
}

TEST(RepresentationTraining, AnInterruptedFitKeepsItsPlan) {
  const test::SmallCapture small = CaptureWithValidation();
  test::ScratchFolder run;
  TrainUntil<GaussiansStepped>(41, small, ConfigOf(Representation::kSplats), run.path());
  GaussianPlan plan;
  const auto start = StartAgain(GaussiansPath(run.path()), plan);
  ASSERT_TRUE(start);
  EXPECT_EQ(plan.steps, 80);
  EXPECT_EQ(plan.seconds, 0);
  EXPECT_EQ(start->state.step, 41);
  EXPECT_EQ(start->made.field_step, test::kSteps);
  EXPECT_GT(start->made.seconds, 0);
}

// With a time budget: whatever the clock says, the field has ended, and the fit goes on.
TEST(RepresentationTraining, AFitWithinABudgetGoesOnWhereItWas) {
  const test::SmallCapture small = CaptureWithValidation();
  Config config = ConfigOf(Representation::kAuto);
  config.train.time_budget = 6;
  test::ScratchFolder run;
  RepresentationRecord decided;
  decided.makes_splats = true;
  decided.field_seconds = 2;
  WriteRepresentation(decided, run.path());
  TrainUntil<GaussiansStepped>(10, small, config, run.path());
  const FitFacts before = OpenGaussians(run.path())->Made();
  // As if writing had taken long: the clock is behind.
  Checkpoint checkpoint = ReadRunCheckpoint(run.path());
  checkpoint.meta["spent_seconds"] = 1.0;
  WriteCheckpoint(CheckpointPath(run.path()), checkpoint);
  std::int64_t first = 0;
  const auto listener = [&](const PipelineEvent& event) {
    const auto* step = std::get_if<GaussiansStepped>(&event);
    if (step && first == 0) first = step->step;
  };
  Trainer trainer(ReadRunCheckpoint(run.path()), small.data, run.path());
  EXPECT_TRUE(
      TrainRepresentations(trainer, small.data, run.path(), test::never_stop, listener).finished);
  EXPECT_EQ(trainer.Steps(), before.field_step);
  EXPECT_EQ(first, 11);
  EXPECT_TRUE(ReadRepresentation(run.path()).reached);
}

TEST(RepresentationTraining, ADamagedFitIsNamed) {
  const test::SmallCapture small = CaptureWithValidation();
  test::ScratchFolder run;
  TrainUntil<GaussiansStepped>(41, small, ConfigOf(Representation::kSplats), run.path());
  Checkpoint checkpoint = ReadCheckpoint(GaussiansPath(run.path()));
  checkpoint.tensors["first_moment"] = torch::zeros({3});
  WriteCheckpoint(GaussiansPath(run.path()), checkpoint);
  EXPECT_THAT(test::InputErrorOf([&] { ReadInterruptedFit(GaussiansPath(run.path())); }),
              HasSubstr("splats.nerf: the fit cannot be resumed"));
  EXPECT_THAT(test::InputErrorOf([&] { Resume(small, run.path()); }), HasSubstr("splats.nerf"));
}

// The user deleted representation.json because it was damaged.
TEST(RepresentationTraining, ALostDecisionLosesNoFit) {
  const test::SmallCapture small = CaptureWithValidation();
  Config config = ConfigOf(Representation::kAuto);
  test::ScratchFolder whole, stopped;
  for (const fs::path& run : {whole.path(), stopped.path()}) {
    RepresentationRecord decided;  // whatever a trial of so few steps says
    decided.makes_splats = true;
    WriteRepresentation(decided, run);
  }
  Train(small, config, whole.path());
  TrainUntil<GaussiansStepped>(41, small, config, stopped.path());
  fs::remove(RepresentationPath(stopped.path()));
  EXPECT_TRUE(Resume(small, stopped.path()).finished);
  ExpectSameTensors(GaussiansPath(whole.path()), GaussiansPath(stopped.path()));
}

TEST(RepresentationTraining, GaussiansOfAnEarlierFieldAreNotAdopted) {
  const test::SmallCapture small = CaptureWithValidation();
  const Config config = ConfigOf(Representation::kSplats);
  test::ScratchFolder whole, stopped;
  Train(small, config, whole.path());
  TrainUntil<StepTaken>(60, small, config, stopped.path());
  // As nerf splat leaves them.
  const std::vector<ColoredPoint> points = {{{0, 0, 0}, {1, 0, 0}}};
  WriteGaussians({config, small.scene, GaussiansAtPoints(points, 16, 3, 1), 0.05, {80, 1, 60}},
                 GaussiansPath(stopped.path()));
  RepresentationRecord record = ReadRepresentation(stopped.path());
  record.reached = {20, 30};
  WriteRepresentation(record, stopped.path());
  EXPECT_TRUE(Resume(small, stopped.path()).finished);
  ExpectSameTensors(GaussiansPath(whole.path()), GaussiansPath(stopped.path()));
  EXPECT_EQ(ReadRepresentation(stopped.path()).reached->splats,
            ReadRepresentation(whole.path()).reached->splats);
}

TEST(RepresentationTraining, ATrialThatWasStoppedIsRepeated) {
  const test::SmallCapture small = CaptureWithValidation();
  const Config config = ConfigOf(Representation::kAuto);
  test::ScratchFolder whole, stopped;
  Train(small, config, whole.path());
  std::atomic<bool> stop = false;
  const auto listener = [&](const PipelineEvent& event) {
    const auto* step = std::get_if<GaussiansStepped>(&event);
    if (step && step->step == 10) stop = true;
  };
  EXPECT_FALSE(Train(small, config, stopped.path(), stop, listener).finished);
  EXPECT_FALSE(ReadRepresentation(stopped.path()).makes_splats);
  EXPECT_TRUE(Resume(small, stopped.path()).finished);
  const RepresentationRecord a = ReadRepresentation(whole.path());
  const RepresentationRecord b = ReadRepresentation(stopped.path());
  ASSERT_TRUE(a.tried && b.tried);
  EXPECT_EQ(a.tried->splats, b.tried->splats);
  EXPECT_EQ(a.tried->field, b.tried->field);
  EXPECT_EQ(a.makes_splats, b.makes_splats);
  ExpectSameTensors(CheckpointPath(whole.path()), CheckpointPath(stopped.path()));
}

}  // namespace
}  // namespace nerf
