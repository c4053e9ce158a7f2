#include "nerf/study/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/base/atomic_file.h"
#include "nerf/effects/effects.h"
#include "nerf/model/evaluation.h"
#include "nerf/model/run_folder.h"
#include "nerf/synthetic/sample_folder.h"
#include "sfm/transforms_json.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_training.h"

namespace nerf {
namespace {

using testing::HasSubstr;

using test::never_stop;

PreparedScene SmallSample(const test::ScratchFolder& folder, int views) {
  synthetic::SampleOptions options;
  options.views = views;
  options.width = 32;
  options.height = 24;
  options.samples_per_pixel = 1;
  synthetic::WriteSample(folder.path() / "sample", options);
  const Config config = LoadConfig("balanced", {});
  PreparedScene scene = PrepareScene(folder.path() / "sample/truth/transforms.json", folder.path(),
                                     config.data, IgnoreEvents);
  InspectScene(config, {}, scene, IgnoreEvents);
  return scene;
}

// After a second of training a field may have no surfaces to begin at, and on a busy machine a
// second is enough for few iterations: a picture is measured, however dark.
void ExpectGaussiansOrAReason(const nlohmann::json& setting) {
  if (setting.contains("left_out")) {
    EXPECT_THAT(setting["left_out"].get<std::string>(), HasSubstr("no surface"));
    EXPECT_FALSE(setting["on_training_front"]);
    return;
  }
  ASSERT_EQ(setting["qualities"].size(), 1u);
  EXPECT_GT(setting["qualities"][0]["psnr"], 0);
  EXPECT_GT(setting["qualities"][0]["seconds_per_frame"], 0);
  EXPECT_GT(setting["stage_seconds"]["gaussians"], 0);
}

// When the budget is spent, each setting still gets a second.
TEST(Study, MeasuresEverySettingAndContinuesWhereItStopped) {
  const test::ScratchFolder folder;
  const PreparedScene scene = SmallSample(folder, 10);
  StudyOptions options;
  options.budget = 1;
  const auto out = folder.path() / "study";
  MakeOutputFolder(out);

  std::atomic<bool> stop = false;
  Study first(scene, options, out, IgnoreEvents);
  std::vector<std::size_t> started;
  const auto on_begin = [&](std::size_t number, const StudySetting&, double seconds) {
    started.push_back(number);
    EXPECT_GE(seconds, 1);
    if (number == 2) stop = true;
  };
  EXPECT_FALSE(first.Run(stop, on_begin));
  EXPECT_EQ(started, (std::vector<std::size_t>{0, 1, 2}));

  Study again(scene, options, out, IgnoreEvents);
  EXPECT_EQ(again.Results()["settings"].size(), 2u);
  EXPECT_TRUE(again.Run(never_stop, on_begin));
  EXPECT_EQ(started[3], 2u);

  const auto json = nlohmann::json::parse(ReadWholeFile(out / "study.json"));
  ASSERT_EQ(json["settings"].size(), again.Settings());
  int on_front = 0;
  for (const auto& setting : json["settings"]) {
    EXPECT_GT(setting["steps"], 0);
    if (setting["assignments"] == nlohmann::json{"train.representation=splats"}) {
      ExpectGaussiansOrAReason(setting);
      continue;
    }
    EXPECT_EQ(setting["qualities"].size(), 5u);
    // The study's scores are those of an evaluation of the run.
    const OpenedRun run = OpenRun(out / "runs" / setting["name"].get<std::string>());
    for (const auto& position : setting["qualities"]) {
      const Evaluation evaluation =
          Evaluate(*run.model, run.posed, ImagesOf(run.posed, Split::kTest),
                   {position["quality"], false, options.downscale});
      EXPECT_NEAR(position["psnr"].get<double>(), evaluation.Mean().psnr, 1e-9);
      EXPECT_NEAR(position["ssim"].get<double>(), evaluation.Mean().ssim, 1e-9);
      EXPECT_GT(position["seconds_per_frame"], 0);
      EXPECT_EQ(evaluation.exposure_fitted,
                run.model->GetModel().config.effects.exposure.has_value());
    }
    EXPECT_GT(setting["stage_seconds"]["networks"], 0);
    on_front += setting["on_training_front"].get<bool>();
  }
  EXPECT_GE(on_front, 1);
  // Each setting is an ordinary run.
  EXPECT_EQ(OpenRun(out / "runs" / "narrow").model->GetModel().config.field.hidden_width, 32);

  options.budget = 2;
  EXPECT_THAT(test::InputErrorOf([&] { Study(scene, options, out, IgnoreEvents); }),
              HasSubstr("budget_seconds"));
}

// With refined poses and focal lengths, which held-out photographs share.
TEST(Study, EvaluatesWithRefinedFocalLengths) {
  const test::ScratchFolder folder;
  PreparedScene scene = SmallSample(folder, 10);
  for (Verdict& verdict : scene.inspection.verdicts) {
    if (verdict.effect == kPoseRefinementEffect.name)
      verdict = Fact(verdict.effect, true, 2, "test");
  }
  StudyOptions options;
  options.budget = 1;
  const auto out = folder.path() / "study";
  MakeOutputFolder(out);
  std::atomic<bool> stop = false;
  Study study(scene, options, out, IgnoreEvents);
  study.Run(stop, [&](std::size_t number, const StudySetting&, double) { stop = number == 1; });
  ASSERT_EQ(study.Results()["settings"].size(), 1u);
  const auto& setting = study.Results()["settings"][0];
  const OpenedRun run = OpenRun(out / "runs" / setting["name"].get<std::string>());
  ASSERT_TRUE(run.model->GetModel().pose_refinement);
  const Evaluation evaluation = Evaluate(*run.model, run.posed, ImagesOf(run.posed, Split::kTest),
                                         {1, false, options.downscale});
  EXPECT_NEAR(setting["qualities"][0]["psnr"].get<double>(), evaluation.Mean().psnr, 1e-9);
}

TEST(Study, OfAnEarlierVersionIsNotContinued) {
  const test::ScratchFolder folder;
  const PreparedScene scene = SmallSample(folder, 10);
  const auto out = folder.path() / "study";
  MakeOutputFolder(out);
  nlohmann::json earlier = Study(scene, StudyOptions{}, out, IgnoreEvents).Results();
  earlier["settings"] = {{{"name", "narrow"}, {"dial", nlohmann::json::array()}}};
  WriteFileAtomically(out / "study.json", earlier.dump());
  EXPECT_THAT(test::InputErrorOf([&] { Study(scene, StudyOptions{}, out, IgnoreEvents); }),
              HasSubstr("earlier version"));
}

TEST(Study, NeedsHeldOutPhotographs) {
  const test::ScratchFolder folder;
  EXPECT_THAT(test::InputErrorOf([&] {
                Study(SmallSample(folder, 5), StudyOptions{}, folder.path(), IgnoreEvents);
              }),
              HasSubstr("held-out"));
}

}  // namespace
}  // namespace nerf
