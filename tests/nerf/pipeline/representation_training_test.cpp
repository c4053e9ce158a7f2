#include "nerf/pipeline/representation_training.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/splats/initial_gaussians.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_capture.h"
#include "tests/support/tiny_training.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::never_stop;
using testing::HasSubstr;

constexpr int kSteps = 120;

// A capture of which the last photographs validate.
test::SmallCapture CaptureWithValidation() {
  test::SmallCapture small = test::MakeSmallCapture(16, 48, 36);
  for (int i = 0; i < 2; ++i) {
    small.data.validation.push_back(small.data.train.back());
    small.data.train.pop_back();
  }
  small.scene = FactsOf(small.data, small.scene.normalized_from_world);
  return small;
}

Config ConfigOf(Representation representation) {
  Config config = test::SmallConfig();
  config.train.representation = representation;
  config.train.steps = kSteps;
  config.train.samples_per_batch = 8192;
  config.splats.count = 600;
  config.splats.steps = 80;
  config.train.checkpoint_every = 30;
  return config;
}

RepresentationsTrained Train(const test::SmallCapture& small, const Config& config,
                             const fs::path& run, const std::atomic<bool>& stop = never_stop,
                             const PipelineListener& listener = IgnoreEvents) {
  Trainer trainer(config, small.scene, small.data, run);
  return TrainRepresentations(trainer, small.data, run, stop, listener);
}

RepresentationsTrained Resume(const test::SmallCapture& small, const fs::path& run) {
  Trainer trainer(ReadRunCheckpoint(run), small.data, run);
  return TrainRepresentations(trainer, small.data, run, never_stop, IgnoreEvents);
}

void ExpectSameTensors(const fs::path& a, const fs::path& b) {
  const Checkpoint first = ReadCheckpoint(a), second = ReadCheckpoint(b);
  ASSERT_EQ(first.tensors.size(), second.tensors.size());
  for (const auto& [name, tensor] : first.tensors) {
    ASSERT_TRUE(second.tensors.contains(name)) << name;
    EXPECT_TRUE(torch::equal(tensor, second.tensors.at(name))) << name;
  }
}

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

TEST(RepresentationTraining, LinearPhotographsAreRefusedWhereGaussiansAreAskedFor) {
  test::SmallCapture small = CaptureWithValidation();
  small.data.encoding = ColorEncoding::kLinear;
  test::ScratchFolder run;
  EXPECT_THAT(
      test::InputErrorOf([&] { Train(small, ConfigOf(Representation::kSplats), run.path()); }),
      HasSubstr("linear photographs; use field"));
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

TEST(RepresentationRecord, IsReadAsItWasWritten) {
  test::ScratchFolder run;
  EXPECT_FALSE(ReadRepresentation(run.path()).makes_splats);
  RepresentationRecord record;
  record.makes_splats = true;
  record.tried = {20, 21};
  record.field_seconds = 17;
  WriteRepresentation(record, run.path());
  EXPECT_EQ(ReadRepresentation(run.path()).makes_splats, true);
  EXPECT_EQ(ReadRepresentation(run.path()).field_seconds, 17);
  EXPECT_EQ(ReadRepresentation(run.path()).tried->splats, 21);
  EXPECT_EQ(ReadRepresentation(run.path()).Best(), Representation::kField);
  record.reached = {30, 31};
  WriteRepresentation(record, run.path());
  EXPECT_EQ(ReadRepresentation(run.path()).Best(), Representation::kSplats);
  record.reached = {31, 31};
  EXPECT_EQ(record.Best(), Representation::kField);
  WriteFileAtomically(RepresentationPath(run.path()), R"({"tried_psnr": {"field": "x"}})");
  EXPECT_THAT(test::InputErrorOf([&] { ReadRepresentation(run.path()); }),
              HasSubstr("representation.json"));
}

// The pixels of a view are looked up where they are drawn: photographs that Gaussians have drawn
// themselves are reached but for rounding.
TEST(GaussianValidation, FindsThePixelsOfAView) {
  test::SmallCapture small = CaptureWithValidation();
  small.scene.has_alpha = true;
  const Config config = ConfigOf(Representation::kSplats);
  std::vector<ColoredPoint> points;
  for (int i = 0; i < 60; ++i) {
    points.push_back({Eigen::Vector3d(i % 4 - 1.5, i / 4 % 4 - 1.5, i / 16 - 1.5) * 0.2,
                      Eigen::Vector3f(i % 3 / 2.0f, i % 5 / 4.0f, i % 7 / 6.0f)});
  }
  const GaussianCloud cloud = GaussiansAtPoints(points, 60, 0, 1);
  constexpr double kNear = 0.05;
  for (View& view : small.data.validation) {
    const GaussianModel model(config, small.scene, cloud, kNear, 0);
    const RenderedView drawn = model.Render(
        {view.camera,
         small.scene.normalized_from_world.WorldFromCamera(view.normalized_from_camera)});
    for (std::size_t p = 0; p < drawn.opacity.pixels.size(); ++p) {
      const float alpha = drawn.opacity.pixels[p];
      for (int c = 0; c < 3; ++c) {
        const float premultiplied = drawn.rgb.pixels[3 * p + c] - (1 - alpha);  // without white
        view.rgba[4 * p + c] = Eigen::half(alpha > 1e-4f ? premultiplied / alpha : 0.0f);
      }
      view.rgba[4 * p + 3] = Eigen::half(alpha);
    }
  }
  const Model field = MakeModel(config, small.scene);
  const GaussianScene scene = GaussianSceneOf(field, small.data);
  const GaussianValidation validation(scene, small.data);
  EXPECT_GT(validation.Psnr(cloud, kNear), 50);
}

}  // namespace
}  // namespace nerf
