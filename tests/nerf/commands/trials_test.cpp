#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "tests/nerf/commands/run_program.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::RunNerf;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

// Captures whose evidence leaves an effect open, and tiny fields that try it.
class TrialsCommands : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  void Sample(const std::string& scenario, const std::string& flags) const {
    const auto made = RunNerf(
        fmt::format("sample {} --scenario {} --samples 2 {}", Path("photos"), scenario, flags));
    ASSERT_EQ(made.exit_status, 0) << made.output;
  }

  // A training that trials have time for.
  //   poses  below the sample
  std::string Train(const std::string& poses, const std::string& run,
                    const std::string& more) const {
    return fmt::format(
        "train {} -o {} --threads 2 --set data.test_every=0 --set encoding.log2_table_size=12 "
        "--set field.hidden_width=16 {}",
        Path("photos/truth/" + poses), Path(run), more);
  }

  // Ends with the first validation.
  static constexpr char kShort[] = "--set train.validate_every=20 --target-psnr 1";

  nlohmann::json Json(const std::string& file) const {
    return nlohmann::json::parse(ReadWholeFile(Path(file)));
  }

  // The effects that were tried, of which each stands in the configuration as it was decided.
  std::vector<std::string> Tried(const std::string& run) const {
    const nlohmann::json effects = Json(run + "/config.json").at("effects");
    const nlohmann::json verdicts = Json(run + "/effects.json").at("verdicts");
    std::vector<std::string> tried;
    for (const auto& verdict : verdicts) {
      const std::string evidence = verdict.at("evidence");
      if (evidence.find("trial: ") == std::string::npos) continue;
      tried.push_back(verdict.at("effect"));
      EXPECT_TRUE(verdict.at("decided"));
      EXPECT_EQ(verdict.at("on"), !effects.at(verdict.at("effect")).is_null());
    }
    return tried;
  }

  test::ScratchFolder folder_;
};

TEST_F(TrialsCommands, WhatTheEvidenceLeavesOpenIsTried) {
  // Without sparse points nothing tells of the exposures.
  ASSERT_NO_FATAL_FAILURE(Sample("exposure", "--views 17 --width 64 --height 48"));
  const auto run = RunNerf(Train("transforms.json", "run", kShort));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_THAT(run.output, AllOf(HasSubstr("dB with it"), HasSubstr("trials took"),
                                Not(HasSubstr("so as configured: exposure"))));
  EXPECT_THAT(Tried("run"), UnorderedElementsAre("exposure"));
  EXPECT_GT(Json("run/effects.json").at("trial_seconds"), 0);

  const auto hasty =
      RunNerf(Train("transforms.json", "hasty", std::string(kShort) + " --set train.steps=3999"));
  ASSERT_EQ(hasty.exit_status, 0) << hasty.output;
  EXPECT_THAT(hasty.output, HasSubstr("so as configured: exposure"))
      << "two trials of 200 steps of half the samples are more than a twentieth";
  EXPECT_THAT(Tried("hasty"), IsEmpty());
}

TEST_F(TrialsCommands, ATrialThatComesToNoNumberDecidesNothing) {
  ASSERT_NO_FATAL_FAILURE(Sample("exposure", "--views 17 --width 64 --height 48"));
  const auto run = RunNerf(
      Train("transforms.json", "run",
            std::string(kShort) + " --set optimizer.learning_rate=1e6 --set field.color_layers=8"));
  EXPECT_THAT(run.output, AllOf(HasSubstr("a trial of exposure diverged"),
                                HasSubstr("so as configured: exposure")));
  EXPECT_THAT(Tried("run"), IsEmpty());
  EXPECT_TRUE(Json("run/config.json").at("effects").at("exposure").is_null());
}

// Poses and the points that depth learns from, which trials alone make use of.
TEST_F(TrialsCommands, PosesAndDepthInBetweenAreTried) {
  ASSERT_NO_FATAL_FAILURE(Sample("pose_refinement", "--views 18 --width 96 --height 72"));
  const auto run =
      RunNerf(Train("sparse", "run", std::string("--effects -view_dependence ") + kShort));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_THAT(Tried("run"), UnorderedElementsAre("depth_supervision", "pose_refinement"))
      << run.output;
  EXPECT_EQ(fs::exists(Path("run/sparse")),
            !Json("run/config.json").at("effects").at("depth_supervision").is_null());
}

// The points are read for the trial; a run that resumes reads those that the run kept.
TEST_F(TrialsCommands, DepthThatATrialDecidedForResumes) {
  ASSERT_NO_FATAL_FAILURE(Sample("depth_supervision", "--views 12 --width 96 --height 72"));
  // Large batches, so that trials fit, of rays that are few.
  const std::string more =
      "--effects -view_dependence,-pose_refinement,-exposure,-robust,-background,-anti_aliasing "
      "--set train.steps=120 "
      "--set train.samples_per_batch=524288 --set train.max_rays_per_batch=512 "
      "--set train.checkpoint_every=40 --set train.validate_every=40";
  const auto straight = RunNerf(Train("sparse", "straight", more));
  ASSERT_EQ(straight.exit_status, 0) << straight.output;
  ASSERT_THAT(Tried("straight"), Contains("depth_supervision")) << straight.output;
  ASSERT_FALSE(Json("straight/config.json").at("effects").at("depth_supervision").is_null())
      << straight.output;

  ASSERT_NO_FATAL_FAILURE(
      test::KillOnce(Path("killed/checkpoint.nerf"), Train("sparse", "killed", more)));
  fs::rename(Path("photos/truth"), Path("photos/elsewhere"));
  const auto resumed = RunNerf("train --resume --threads 2 -o " + Path("killed"));
  ASSERT_EQ(resumed.exit_status, 0) << resumed.output;
  const auto loss = [&](const std::string& run) {
    const std::string lines = ReadWholeFile(Path(run + "/metrics.jsonl"));
    const auto last = nlohmann::json::parse(lines.substr(lines.rfind('\n', lines.size() - 2) + 1));
    EXPECT_EQ(last.at("step"), 120);
    return last.at("loss").get<double>();
  };
  EXPECT_EQ(loss("killed"), loss("straight"));
}

}  // namespace
}  // namespace nerf
