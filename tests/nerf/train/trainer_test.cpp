#include "nerf/train/trainer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <thread>

#include "nerf/base/parallel.h"
#include "nerf/base/stopwatch.h"
#include "nerf/image/image_metrics.h"
#include "nerf/model/checkpoint.h"
#include "nerf/model/run_folder.h"
#include "nerf/render/engine.h"
#include "nerf/render/image_renderer.h"
#include "nerf/render/view_renderer.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_capture.h"
#include "tests/support/tiny_training.h"

namespace nerf {
namespace {

using test::never_stop;

void ExpectSameTensors(const Checkpoint& a, const Checkpoint& b) {
  ASSERT_EQ(a.tensors.size(), b.tensors.size());
  for (const auto& [name, tensor] : a.tensors) {
    EXPECT_TRUE(torch::equal(tensor, b.tensors.at(name))) << name;
  }
}

Config FewSteps(std::int64_t steps) {
  Config config = test::SmallConfig();
  config.train.steps = steps;
  config.train.samples_per_batch = 2048;
  config.train.checkpoint_every = 20;
  return config;
}

TEST(Trainer, TheSameSeedAndThreadsGiveTheSameBits) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 32, 24);
  test::ScratchFolder a, b;
  Trainer(FewSteps(40), small.scene, small.data, a.path()).Run(never_stop);
  Trainer(FewSteps(40), small.scene, small.data, b.path()).Run(never_stop);
  ExpectSameTensors(ReadRunCheckpoint(a.path()), ReadRunCheckpoint(b.path()));
}

TEST(Trainer, AResumedRunEqualsAnUninterruptedOneBitForBit) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 32, 24);
  test::ScratchFolder uninterrupted, interrupted;
  Trainer(FewSteps(100), small.scene, small.data, uninterrupted.path()).Run(never_stop);

  // Stopped by request some steps after its first checkpoint.
  std::atomic<bool> stop = false;
  std::thread watcher([&] {
    while (!std::filesystem::exists(CheckpointPath(interrupted.path()))) std::this_thread::yield();
    stop = true;
  });
  const TrainSummary stopped =
      Trainer(FewSteps(100), small.scene, small.data, interrupted.path()).Run(stop);
  watcher.join();
  ASSERT_FALSE(stopped.finished);
  ASSERT_GE(stopped.step, 20);

  Trainer resumed(ReadRunCheckpoint(interrupted.path()), small.data, interrupted.path());
  EXPECT_TRUE(resumed.Run(never_stop).finished);
  ExpectSameTensors(ReadRunCheckpoint(uninterrupted.path()), ReadRunCheckpoint(interrupted.path()));
}

TEST(Trainer, ATimeBudgetEndsTheRunAtTheFinalLearningRate) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 32, 24);
  test::ScratchFolder run;
  Config config = FewSteps(1);  // ignored with a time budget
  config.train.time_budget = 5;
  config.train.validate_every = 10;
  Trainer trainer(config, small.scene, small.data, run.path(), 3.0);
  const TrainSummary summary = trainer.Run(never_stop);
  EXPECT_TRUE(summary.finished);
  EXPECT_GT(summary.step, 1);
  // 3 of the 5 seconds were already spent. How much of the rest is used depends on the machine.
  EXPECT_LE(summary.training_seconds, 2.0);
  std::ifstream metrics(MetricsPath(run.path()));
  nlohmann::json last;
  for (std::string line; std::getline(metrics, line);) last = nlohmann::json::parse(line);
  EXPECT_NEAR(last["learning_rate"].get<double>(),
              config.optimizer.learning_rate * config.schedule.final_factor,
              0.02 * config.optimizer.learning_rate);
  EXPECT_EQ(last["step"], summary.step);
  EXPECT_EQ(ReadRunCheckpoint(run.path()).meta["step"], summary.step);
}

TEST(Trainer, ResumingWithAnExhaustedBudgetTakesNoSteps) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 32, 24);
  test::ScratchFolder run;
  Config config = FewSteps(1);
  config.train.time_budget = 2;
  Trainer(config, small.scene, small.data, run.path()).Run(never_stop);
  const Checkpoint checkpoint = ReadRunCheckpoint(run.path());
  Trainer again(checkpoint, small.data, run.path(), 1.0);
  const TrainSummary summary = again.Run(never_stop);
  EXPECT_TRUE(summary.finished);
  EXPECT_EQ(summary.step, checkpoint.meta["step"]);
}

// PSNR of a constant picture with the mean colour of a view.
double PsnrOfMeanColor(const View& view) {
  const auto pixels = static_cast<double>(view.rgba.size() / 4);
  std::array<double, 3> mean{}, squares{};
  for (std::size_t i = 0; i < view.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    const auto value = static_cast<double>(static_cast<float>(view.rgba[i]));
    mean[i % 4] += value / pixels;
    squares[i % 4] += value * value / pixels;
  }
  double error = 0;
  for (int c = 0; c < 3; ++c) error += (squares[c] - mean[c] * mean[c]) / 3;
  return -10 * std::log10(error);
}

TEST(Trainer, EndsWhenValidationReachesTheTarget) {
  test::SmallCapture small = test::MakeSmallCapture(36, 32, 24);
  small.data.validation.push_back(small.data.train.back());
  small.data.train.pop_back();
  test::ScratchFolder run;
  Config config = FewSteps(1000);
  config.train.validate_every = 10;
  // More than a constant colour can reach.
  config.train.target_psnr = PsnrOfMeanColor(small.data.validation.front()) + 1;
  std::vector<double> psnrs;
  const TrainSummary summary = Trainer(config, small.scene, small.data, run.path())
                                   .Run(never_stop, [&](const TrainerEvent& event) {
                                     const auto* validated = std::get_if<Validated>(&event);
                                     if (validated) psnrs.push_back(validated->psnr);
                                   });
  EXPECT_TRUE(summary.finished);
  EXPECT_TRUE(summary.reached_target);
  EXPECT_LT(summary.step, 1000);
  ASSERT_GE(psnrs.size(), 2u);
  EXPECT_EQ(summary.step, 10 * std::ssize(psnrs));
  EXPECT_EQ(psnrs.back(), summary.validation_psnr);
  EXPECT_GE(psnrs.back(), config.train.target_psnr);
  psnrs.pop_back();
  for (const double psnr : psnrs) EXPECT_LT(psnr, config.train.target_psnr);  // it ended at once
  EXPECT_EQ(ReadRunCheckpoint(run.path()).meta["step"], summary.step);
}

// Each stage has its own timer. If one was counted twice, they would sum to more than the step.
TEST(Trainer, TimedStagesSumToAtMostTheTimeOfTheSteps) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 32, 24);
  for (const SamplerKind sampler : {SamplerKind::kProposal, SamplerKind::kOccupancy}) {
    test::ScratchFolder run;
    Config config = FewSteps(40);
    config.march.sampler = sampler;
    Trainer(config, small.scene, small.data, run.path()).Run(never_stop);
    std::ifstream metrics(MetricsPath(run.path()));
    std::string line;
    ASSERT_TRUE(std::getline(metrics, line));
    const auto json = nlohmann::json::parse(line);
    double timed = 0;
    for (const char* stage :
         {"pixels", "occupancy", "sampling", "encoding", "networks", "compositing", "optimizer"}) {
      const double seconds = json["stage_seconds"][stage];
      EXPECT_GE(seconds, 0) << stage;
      if (std::string(stage) != "occupancy") {
        EXPECT_GT(seconds, 0) << stage;
      }
      timed += seconds;
    }
    EXPECT_LE(timed, 1.001 * json["seconds"].get<double>());
    EXPECT_GE(json["samples_skipped"].get<double>(), 0);
    EXPECT_LT(json["samples_skipped"].get<double>(), 1);
    EXPECT_GT(json["peak_megabytes"].get<double>(), 10);
  }
}

TEST(Trainer, TakesNoMoreThanTheRemainingStepsAndTimesThem) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 32, 24);
  Trainer trainer(FewSteps(5), small.scene, small.data, {});
  const Stopwatch watch;
  const double mean = trainer.TakeSteps(1000);
  EXPECT_GT(mean, 0);
  EXPECT_GT(5 * mean, 0.5 * watch.Seconds());  // not divided by 1000
  EXPECT_EQ(trainer.TakeSteps(1), 0);
}

TEST(Trainer, GeneralisesToHeldOutViews) {
  const test::SmallCapture small = test::MakeSmallCapture(72, 64, 48);
  test::ScratchFolder run;
  Trainer trainer(test::SmallConfig(), small.scene, small.data, run.path());
  const TrainSummary summary = trainer.Run(never_stop);
  EXPECT_TRUE(summary.finished);

  const PosedImages& posed = small.capture.posed;
  double psnr = 0;
  int views = 0;
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    if (posed.images[i].split != Split::kTest) continue;
    const RenderedView view = RenderView(
        *MakeRenderer(trainer.GetModel()), posed.cameras[posed.images[i].camera],
        small.scene.normalized_from_world.NormalizedFromCamera(posed.images[i].world_from_camera),
        Eigen::Vector3f::Zero(), ColorEncoding::kSrgb);
    psnr += Psnr(small.capture.views[i].photo, view.rgb);
    ++views;
  }
  EXPECT_GT(psnr / views, 18.0);  // the mean colour has 12 dB
  RecordProperty("held_out_psnr", std::to_string(psnr / views));
}

TEST(Trainer, WritesOneLineOfMetricsPerValidation) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 32, 24);
  test::ScratchFolder run;
  Config config = FewSteps(30);
  config.train.validate_every = 10;
  Trainer(config, small.scene, small.data, run.path()).Run(never_stop);
  std::ifstream file(MetricsPath(run.path()));
  std::vector<int> steps;
  for (std::string line; std::getline(file, line);) {
    const auto json = nlohmann::json::parse(line);
    steps.push_back(json.at("step"));
    EXPECT_GT(json.at("rays_per_second"), 0);
    EXPECT_GT(json.at("seconds"), 0);
  }
  EXPECT_EQ(steps, (std::vector<int>{10, 20, 30}));
}

}  // namespace
}  // namespace nerf
