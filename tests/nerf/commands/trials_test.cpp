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

// Captures with inconclusive evidence on an effect, and tiny runs with trials of it.
class TrialsCommands : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  void Sample(const std::string& scenario, const std::string& flags) const {
    const auto made = RunNerf(
        fmt::format("sample {} --scenario {} --samples 2 {}", Path("photos"), scenario, flags));
    ASSERT_EQ(made.exit_status, 0) << made.output;
  }

  // A training that is long enough for trials.
  //   poses  path below the sample's folder truth
  std::string Train(const std::string& poses, const std::string& run,
                    const std::string& flags) const {
    return fmt::format(
        "train {} -o {} --threads 2 --set data.test_every=0 --set encoding.log2_table_size=12 "
        "--set field.hidden_width=16 {}",
        Path("photos/truth/" + poses), Path(run), flags);
  }

  // Ends at the first validation.
  static constexpr char kShort[] = "--set train.validate_every=20 --target-psnr 1";

  nlohmann::json Json(const std::string& file) const {
    return nlohmann::json::parse(ReadWholeFile(Path(file)));
  }

  // The effects that were tried. Checks that the configuration contains the decisions.
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

TEST_F(TrialsCommands, InconclusiveEffectsAreTried) {
  // Without sparse points there is no evidence on exposures.
  ASSERT_NO_FATAL_FAILURE(Sample("exposure", "--views 17 --width 64 --height 48"));
  const auto run = RunNerf(Train("transforms.json", "run", kShort));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_THAT(run.output, AllOf(HasSubstr("dB with it"), HasSubstr("trials took"),
                                Not(HasSubstr("as configured: exposure"))));
  EXPECT_THAT(Tried("run"), UnorderedElementsAre("exposure"));
  EXPECT_GT(Json("run/effects.json").at("trial_seconds"), 0);

  const auto shorter =
      RunNerf(Train("transforms.json", "shorter", std::string(kShort) + " --set train.steps=3999"));
  ASSERT_EQ(shorter.exit_status, 0) << shorter.output;
  EXPECT_THAT(shorter.output, HasSubstr("as configured: exposure"))
      << "two trials of 200 steps with half the samples are more than a twentieth";
  EXPECT_THAT(Tried("shorter"), IsEmpty());
}

TEST_F(TrialsCommands, ATrialThatDivergesDecidesNothing) {
  ASSERT_NO_FATAL_FAILURE(Sample("exposure", "--views 17 --width 64 --height 48"));
  const auto run = RunNerf(
      Train("transforms.json", "run",
            std::string(kShort) + " --set optimizer.learning_rate=1e6 --set field.color_layers=8"));
  EXPECT_THAT(run.output, AllOf(HasSubstr("a trial of exposure diverged"),
                                HasSubstr("as configured: exposure")));
  EXPECT_THAT(Tried("run"), IsEmpty());
  EXPECT_TRUE(Json("run/config.json").at("effects").at("exposure").is_null());
}

// Also the trial of depth supervision, whose points are loaded only for it.
TEST_F(TrialsCommands, InconclusivePosesAndDepthAreTried) {
  ASSERT_NO_FATAL_FAILURE(Sample("pose_refinement", "--views 18 --width 96 --height 72"));
  const auto run =
      RunNerf(Train("sparse", "run", std::string("--effects -view_dependence ") + kShort));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_THAT(Tried("run"), UnorderedElementsAre("depth_supervision", "pose_refinement"))
      << run.output;
  EXPECT_EQ(fs::exists(Path("run/sparse")),
            !Json("run/config.json").at("effects").at("depth_supervision").is_null());
}

// The trial uses the points of the input; a resumed run uses those that the run saved.
TEST_F(TrialsCommands, ARunWithDepthSupervisionByATrialResumes) {
  ASSERT_NO_FATAL_FAILURE(Sample("depth_supervision", "--views 12 --width 96 --height 72"));
  // Large batches, so that trials fit in the allowance, but with few rays.
  const std::string flags =
      "--effects -view_dependence,-pose_refinement,-exposure,-robust,-background,-anti_aliasing "
      "--set train.steps=120 "
      "--set train.samples_per_batch=524288 --set train.max_rays_per_batch=512 "
      "--set train.checkpoint_every=40 --set train.validate_every=40";
  const auto uninterrupted = RunNerf(Train("sparse", "uninterrupted", flags));
  ASSERT_EQ(uninterrupted.exit_status, 0) << uninterrupted.output;
  ASSERT_THAT(Tried("uninterrupted"), Contains("depth_supervision")) << uninterrupted.output;
  ASSERT_FALSE(Json("uninterrupted/config.json").at("effects").at("depth_supervision").is_null())
      << uninterrupted.output;

  ASSERT_NO_FATAL_FAILURE(
      test::KillWhenExists(Path("killed/checkpoint.nerf"), Train("sparse", "killed", flags)));
  fs::rename(Path("photos/truth"), Path("photos/elsewhere"));
  const auto resumed = RunNerf("train --resume --threads 2 -o " + Path("killed"));
  ASSERT_EQ(resumed.exit_status, 0) << resumed.output;
  const auto loss = [&](const std::string& run) {
    const std::string lines = ReadWholeFile(Path(run + "/metrics.jsonl"));
    const auto last = nlohmann::json::parse(lines.substr(lines.rfind('\n', lines.size() - 2) + 1));
    EXPECT_EQ(last.at("step"), 120);
    return last.at("loss").get<double>();
  };
  EXPECT_EQ(loss("killed"), loss("uninterrupted"));
}

}  // namespace
}  // namespace nerf
