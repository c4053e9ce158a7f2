#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "nerf/base/atomic_file.h"
#include "tests/nerf/commands/run_program.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::RunNerf;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A small capture with true poses, generated once.
class TrainCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::ScratchFolder;
    const auto made =
        RunNerf("sample " + Path("sample") + " --views 10 --width 48 --height 36 --samples 1");
    ASSERT_EQ(made.exit_status, 0) << made.output;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string Path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string Poses() { return Path("sample/truth/transforms.json"); }

  // A run of 200 tiny steps with a checkpoint in the middle.
  static std::string Arguments(const std::string& run) {
    return fmt::format(
        "train {} -o {} --threads 2 --set train.steps=200 --set train.checkpoint_every=100 "
        "--set train.samples_per_batch=2048 --set train.validate_every=50 "
        "--set encoding.log2_table_size=12 --set field.hidden_width=16 "
        "--set occupancy.resolution=32 --set march.steps_per_unit=32 "
        "--set occupancy.coarse_to_fine_steps=50",
        Poses(), Path(run));
  }

  // Starts a run and kills it with SIGKILL as soon as its first checkpoint exists.
  static void KillAtFirstCheckpoint(const std::string& run) {
    test::KillWhenExists(Path(run + "/checkpoint.nerf"), Arguments(run));
  }

  // Expects exit status 2 and a message of one line.
  static void ExpectRejected(const std::string& arguments,
                             const testing::Matcher<std::string>& message) {
    const auto result = RunNerf(arguments);
    EXPECT_EQ(result.exit_status, 2) << result.output;
    EXPECT_THAT(result.output, message);
    EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
  }

  static test::ScratchFolder* folder_;
};
test::ScratchFolder* TrainCommand::folder_ = nullptr;

TEST_F(TrainCommand, AKilledRunResumesBitForBit) {
  const auto uninterrupted = RunNerf(Arguments("uninterrupted"));
  ASSERT_EQ(uninterrupted.exit_status, 0) << uninterrupted.output;

  ASSERT_NO_FATAL_FAILURE(KillAtFirstCheckpoint("killed"));
  const auto resumed = RunNerf("train --resume --threads 2 -o " + Path("killed"));
  ASSERT_EQ(resumed.exit_status, 0) << resumed.output;
  // Equal scores in all digits imply equal parameters (torch_tests compare them bit by bit).
  const auto scores = [](const std::string& run) {
    const auto eval = RunNerf("eval --json " + Path(run));
    EXPECT_EQ(eval.exit_status, 0) << eval.output;
    auto json = nlohmann::json::parse(eval.output);
    for (auto& image : json["images"]) image.erase("seconds");
    return json["images"].dump();
  };
  EXPECT_EQ(scores("uninterrupted"), scores("killed"));

  // A finished run is not overwritten.
  ExpectRejected(Arguments("killed"), AllOf(HasSubstr("--resume"), HasSubstr("killed")));
  for (const char* change : {" --set train.steps=5", " --config fast", " --downscale 2"}) {
    ExpectRejected("train --resume -o " + Path("killed") + change, HasSubstr("--set"));
  }
}

// A limit on the file size simulates a full disk: write() fails half-way in the same way.
TEST_F(TrainCommand, AFullDiskKeepsTheLastGoodCheckpoint) {
  ASSERT_NO_FATAL_FAILURE(KillAtFirstCheckpoint("full"));
  const std::string resume = "train --resume --threads 2 -o " + Path("full");
  const std::string before = ReadWholeFile(Path("full/checkpoint.nerf"));
  const auto full = RunNerf(resume, "trap '' XFSZ; ulimit -f 64;");
  EXPECT_EQ(full.exit_status, 2) << full.output;
  EXPECT_THAT(full.output, AllOf(HasSubstr("full/checkpoint.nerf"), HasSubstr("cannot be written"),
                                 Not(HasSubstr("terminate"))));
  EXPECT_TRUE(ReadWholeFile(Path("full/checkpoint.nerf")) == before);
  const auto resumed = RunNerf(resume);
  EXPECT_EQ(resumed.exit_status, 0) << resumed.output;
}

TEST_F(TrainCommand, RendersAndEvaluates) {
  ASSERT_EQ(RunNerf(Arguments("run")).exit_status, 0);
  const auto eval = RunNerf("eval " + Path("run"));
  EXPECT_EQ(eval.exit_status, 0) << eval.output;
  EXPECT_THAT(eval.output, AllOf(HasSubstr("\nview_000.png "), HasSubstr("mean")))
      << "images must have the names of the input";
  EXPECT_TRUE(fs::exists(Path("run/eval/contact_sheet.png")));

  EXPECT_EQ(RunNerf("render " + Path("run") + " --depth --opacity").exit_status, 0);
  for (const char* name : {"png", "depth.exr", "depth.png", "opacity.png"}) {
    bool found = false;
    for (const auto& entry : fs::directory_iterator(Path("run/renders/held-out"))) {
      found = found || entry.path().string().ends_with(name);
    }
    EXPECT_TRUE(found) << name;
  }
  const auto film = RunNerf("render " + Path("run") + " --path orbit --frames 3");
  EXPECT_EQ(film.exit_status, 0) << film.output;
  EXPECT_TRUE(fs::exists(Path("run/renders/orbit/00002.png")));
  EXPECT_TRUE(fs::exists(Path("run/renders/orbit/film.mp4")));
  EXPECT_TRUE(fs::exists(Path("run/renders/held-out/view_000.png")));
  const auto one = RunNerf("render " + Path("run") + " --image view_003.png");
  EXPECT_EQ(one.exit_status, 0) << one.output;
  EXPECT_TRUE(fs::exists(Path("run/renders/image/view_003.png")));
  ExpectRejected("render " + Path("run") + " --path orbit --fps 0", HasSubstr("--fps"));
  folder_->Write("pose.json",
                 R"({"transform_matrix": [[1,0,0,0],[0,0,-1,-3],[0,1,0,1],[0,0,0,1]], "fov": 40})");
  EXPECT_EQ(
      RunNerf("render --pose " + Path("pose.json") + " --format exr " + Path("run")).exit_status,
      0);
  EXPECT_TRUE(fs::exists(Path("run/renders/pose/pose.exr")));
  ExpectRejected("render " + Path("run") + " --image none.png", HasSubstr("none.png"));
}

TEST_F(TrainCommand, RendersWithoutPhotographsAndEvalNamesMissingOnes) {
  fs::copy(Path("sample"), Path("moved"), fs::copy_options::recursive);
  const auto trained =
      RunNerf("train " + Path("moved/truth/transforms.json") + " -o " + Path("moved-run") +
              " --set train.steps=2 --set train.samples_per_batch=512");
  ASSERT_EQ(trained.exit_status, 0) << trained.output;
  fs::remove(Path("moved/images/view_000.png"));
  const auto eval = RunNerf("eval " + Path("moved-run"));
  EXPECT_EQ(eval.exit_status, 0) << eval.output;
  EXPECT_THAT(eval.output, AllOf(HasSubstr("view_000.png"), HasSubstr("1 of 2 images")));
  fs::remove_all(Path("moved/images"));
  const auto render = RunNerf("render " + Path("moved-run") + " --path orbit --frames 1");
  EXPECT_EQ(render.exit_status, 0) << render.output;
  const auto none = RunNerf("eval " + Path("moved-run"));
  EXPECT_EQ(none.exit_status, 2) << none.output;
  EXPECT_THAT(none.output, HasSubstr("none of the"));
}

TEST_F(TrainCommand, DoesNotOverwriteForeignFiles) {
  fs::copy(Path("sample/truth"), Path("mine"), fs::copy_options::recursive);
  const std::string before = ReadWholeFile(Path("mine/transforms.json"));
  ExpectRejected("train " + Path("mine/transforms.json") + " -o " + Path("mine"),
                 AllOf(HasSubstr("mine/transforms.json"), HasSubstr("-o")));
  EXPECT_EQ(ReadWholeFile(Path("mine/transforms.json")), before);
  EXPECT_FALSE(fs::exists(Path("mine/config.json")));
}

TEST_F(TrainCommand, PrintsNoProgressWithoutATerminal) {
  const auto result = RunNerf(Arguments("quiet"));
  EXPECT_EQ(result.exit_status, 0) << result.output;
  EXPECT_LE(std::ranges::count(result.output, '\n'), 7) << result.output;
  EXPECT_THAT(result.output, Not(HasSubstr("\r")));
}

TEST_F(TrainCommand, BadInputIsReportedInOneLine) {
  ExpectRejected("train /no/such/folder -o " + Path("x"), HasSubstr("/no/such/folder"));
  fs::create_directories(Path("empty"));
  ExpectRejected("train " + Path("empty") + " -o " + Path("x"), HasSubstr("empty"));
  ExpectRejected("train " + Poses() + " -o " + Path("x") + " --config fsat", HasSubstr("fsat"));
  ExpectRejected("train " + Poses() + " -o " + Path("x") + " --set train.stps=1",
                 HasSubstr("train.stps"));
  ExpectRejected("train " + Poses() + " -o " + Path("x") + " --set train.steps=no",
                 HasSubstr("train.steps"));
  ExpectRejected("train " + Poses() + " -o /proc/nope", HasSubstr("/proc/nope"));
  ExpectRejected("train " + Poses() + " -o " + Path(std::string(300, 'x')), HasSubstr("xxx"));
  ExpectRejected("train " + Poses() + " -o " + Path("x") + " --set optimizer.learning_rate=1e39",
                 HasSubstr("learning_rate"));
  ExpectRejected("train " + Poses() + " --no-such-flag", HasSubstr("no-such-flag"));
  ExpectRejected("train --resume -o " + Path("x"), HasSubstr("checkpoint"));
  ExpectRejected("train " + Poses() + " --threads -1 -o " + Path("x"), HasSubstr("--threads"));
  ExpectRejected("train " + Poses() + " -o " + Path("x") + " --time-budget soon",
                 HasSubstr("--time-budget"));
  ExpectRejected("train " + Poses() + " -o " + Path("x") + " --time-budget -5s",
                 HasSubstr("time_budget"));
  ExpectRejected(
      "train " + Poses() + " -o " + Path("x") + " --target-psnr 30 --set data.validation_images=0",
      HasSubstr("data.validation_images"));
  ExpectRejected("train --resume --time-budget 5s -o " + Path("x"), HasSubstr("--time-budget"));
  ExpectRejected("train --resume --effects +robust -o " + Path("x"), HasSubstr("--effects"));
  EXPECT_FALSE(fs::exists(Path("x")));
}

TEST_F(TrainCommand, ATimeBudgetOverridesTheNumberOfSteps) {
  const auto result =
      RunNerf(Arguments("budget") + " --time-budget 0.1m --set train.steps=100000000");
  ASSERT_EQ(result.exit_status, 0) << result.output;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("time budget 0:06: preset"), HasSubstr("next: nerf eval")));
  const auto config = nlohmann::json::parse(ReadWholeFile(Path("budget/config.json")));
  EXPECT_EQ(config["train"]["time_budget"], 6);
}

TEST_F(TrainCommand, ATargetPsnrEndsTheRunAndIsReported) {
  const auto made =
      RunNerf("sample " + Path("more") + " --views 20 --width 32 --height 24 --samples 1");
  ASSERT_EQ(made.exit_status, 0) << made.output;
  const auto train = [](const std::string& run, const std::string& target) {
    return RunNerf("train " + Path("more/truth/transforms.json") + " -o " + Path(run) +
                   " --config quickstart --set train.steps=60 --set train.validate_every=20"
                   " --set data.downscale=1 --set train.samples_per_batch=1024 --target-psnr " +
                   target);
  };
  const auto reached = train("target", "1");
  ASSERT_EQ(reached.exit_status, 0) << reached.output;
  EXPECT_THAT(reached.output,
              AllOf(HasSubstr("trained 20 steps"), HasSubstr("target of 1 dB reached")));
  const auto missed = train("missed", "99");
  ASSERT_EQ(missed.exit_status, 0) << missed.output;
  EXPECT_THAT(missed.output,
              AllOf(HasSubstr("trained 60 steps"), HasSubstr("target of 99 dB not reached")));
  // Ten photographs have no validation split.
  const auto unvalidated = RunNerf(Arguments("unvalidated") + " --target-psnr 30");
  EXPECT_EQ(unvalidated.exit_status, 2);
  EXPECT_THAT(unvalidated.output, HasSubstr("data.validation_images"));
}

TEST_F(TrainCommand, RenderingQualityReportsItsCostAndError) {
  ASSERT_EQ(RunNerf(Arguments("quality")).exit_status, 0);
  const auto fast = RunNerf("render " + Path("quality") + " --quality 0.25");
  EXPECT_EQ(fast.exit_status, 0) << fast.output;
  EXPECT_THAT(fast.output, AllOf(HasSubstr("quality 0.25: about"), HasSubstr("dB from the exact")));
  const auto exact = RunNerf("render " + Path("quality") + " --seconds-per-frame 1000");
  EXPECT_THAT(exact.output, AllOf(HasSubstr("quality 1.00"), HasSubstr("the exact picture")));
  const auto fastest = RunNerf("render " + Path("quality") + " --seconds-per-frame 1e-9");
  EXPECT_EQ(fastest.exit_status, 0) << fastest.output;
  EXPECT_THAT(fastest.output, AllOf(HasSubstr("quality 0.00"), HasSubstr("--downscale")));
  ExpectRejected("render " + Path("quality") + " --seconds-per-frame 0",
                 HasSubstr("--seconds-per-frame"));
  ExpectRejected("render " + Path("quality") + " --seconds-per-frame 1 --quality 1",
                 HasSubstr("--quality"));
  const auto eval = RunNerf("eval --json " + Path("quality"));
  const auto json = nlohmann::json::parse(eval.output);
  for (const char* stage : {"sampling", "encoding", "networks", "compositing"}) {
    EXPECT_GT(json["stage_seconds_per_frame"][stage].get<double>(), 0) << stage;
  }
  EXPECT_GT(json["samples_per_ray"].get<double>(), 0);
}

TEST_F(TrainCommand, ABrokenCheckpointIsNamed) {
  folder_->Write("broken/checkpoint.nerf", "NERFCKPT but not much more");
  ExpectRejected("eval " + Path("broken"), HasSubstr("broken/checkpoint.nerf"));
  ExpectRejected("render " + Path("broken"), HasSubstr("broken/checkpoint.nerf"));
}

TEST_F(TrainCommand, BrokenPosesAreNamed) {
  folder_->Write("bad/transforms.json", R"({"frames": [)");
  ExpectRejected("train " + Path("bad") + " -o " + Path("x"), HasSubstr("bad/transforms.json"));
  auto poses = nlohmann::json::parse(ReadWholeFile(Poses()));
  for (auto& frame : poses["frames"]) {
    frame["file_path"] = Path("sample/images/") +
                         fs::path(frame["file_path"].get<std::string>()).filename().string();
  }
  auto mirrored = poses;
  for (int i = 0; i < 4; ++i) {
    double& entry = *mirrored["frames"][3]["transform_matrix"][i][0].get_ptr<double*>();
    entry = -entry;
  }
  folder_->Write("mirrored/transforms.json", mirrored.dump());
  ExpectRejected("train " + Path("mirrored") + " -o " + Path("x"), HasSubstr("frames[3]"));
}

TEST_F(TrainCommand, ATruncatedPhotographIsNamedAndSkipped) {
  fs::copy(Path("sample"), Path("cut"), fs::copy_options::recursive);
  const fs::path photo = Path("cut/images/view_003.png");
  fs::resize_file(photo, fs::file_size(photo) / 2);
  const auto result =
      RunNerf("train " + Path("cut/truth/transforms.json") + " -o " + Path("cut-run") +
              " --set train.steps=2 --set train.samples_per_batch=512");
  EXPECT_EQ(result.exit_status, 0) << result.output;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("view_003.png"), HasSubstr("1 images could not be read")));
}

}  // namespace
}  // namespace nerf
