#include "sfm/colmap_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <stdexcept>

#include "tests/support/fake_colmap.h"
#include "tests/support/input_error_of.h"
#include "tests/support/photo_files.h"

namespace nerf::sfm {
namespace {

using nerf::test::FakeColmap;
using nerf::test::FileBytes;
using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using testing::AllOf;
using testing::HasSubstr;

class ColmapProgramTest : public testing::Test {
 protected:
  ColmapProgram::Outcome RunMapper(const std::string& script) {
    fake_.Set("do_mapper", script);
    return ColmapProgram::Find().Run("mapper", {"--x", "1"}, Log(),
                                     [&](std::string_view line) { heard_.emplace_back(line); });
  }
  std::filesystem::path Log() const { return scratch_.path() / "mapper.log"; }

  FakeColmap fake_;
  ScratchFolder scratch_;
  std::vector<std::string> heard_;
};

TEST_F(ColmapProgramTest, MissingProgramIsAnErrorWithInstallInstructions) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", scratch_.path().c_str(), 1);
  EXPECT_THAT(InputErrorOf([] { ColmapProgram::Find(); }),
              AllOf(HasSubstr("apt install colmap"), HasSubstr("transforms.json")));
  setenv("PATH", path.c_str(), 1);
}

TEST_F(ColmapProgramTest, OptionsAreNamedAsTheProgramListsThem) {
  const auto known = [] {
    return ColmapProgram::Find().KnownOption(
        "feature_extractor", {"SiftExtraction.use_gpu", "FeatureExtraction.use_gpu"});
  };
  EXPECT_EQ(known(), "SiftExtraction.use_gpu");
  fake_.Set("help", "  --FeatureExtraction.use_gpu arg (=1)\n");
  EXPECT_EQ(known(), "FeatureExtraction.use_gpu");
  fake_.Set("help", "  --SiftExtraction.use_gpu_index arg\n");
  EXPECT_EQ(known(), "");
}

TEST_F(ColmapProgramTest, VersionIsTheOneThatHelpPrints) {
  const auto version = [&](const std::string& line) {
    fake_.Set("version", line + "\nUsage:\n");
    return ColmapProgram::Find().Version();
  };
  EXPECT_EQ(version("COLMAP 3.8 -- Structure-from-Motion"), (std::array{3, 8, 0}));
  EXPECT_EQ(version("COLMAP 3.10-dev -- Structure-from-Motion"), (std::array{3, 10, 0}));
  EXPECT_EQ(version("COLMAP 4.1.1 (Commit a on b without CUDA)"), (std::array{4, 1, 1}));
  EXPECT_EQ(version("another program"), (std::array{0, 0, 0}));
  for (const auto& [line, resolves] :
       {std::pair{"COLMAP 3.12.6", false}, std::pair{"COLMAP 3.13.0", true},
        std::pair{"COLMAP 4.0.3", true}, std::pair{"COLMAP 4.0.4", false}}) {
    fake_.Set("version", line);
    EXPECT_EQ(ColmapProgram::Find().ResolvesLinks(), resolves) << line;
  }
}

TEST_F(ColmapProgramTest, BothStreamsAreReadAndLoggedAndThereIsNoDisplay) {
  const auto outcome = RunMapper("echo one; echo two >&2; echo $QT_QPA_PLATFORM $TMPDIR");
  EXPECT_EQ(outcome.exit_code, 0);
  // Nothing is written outside the workspace.
  EXPECT_THAT(heard_,
              testing::ElementsAre("one", "two", "offscreen " + Log().parent_path().string()));
  EXPECT_THAT(FileBytes(Log()), AllOf(HasSubstr("mapper --x 1\n"), HasSubstr("one\ntwo\n")));
}

TEST_F(ColmapProgramTest, FailureIsExplainedByTheErrorMessageNotByLaterOutput) {
  const auto outcome = RunMapper(
      "echo 'Loading database'; echo 'ERROR: cannot open it'; echo '*** Check failure stack "
      "trace: ***'; echo '    @ 0x7f00 (unknown)'; echo; exit 3");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.last_line, "ERROR: cannot open it");
  EXPECT_THAT(InputErrorOf([&] { ThrowStepFailed("mapper", outcome, Log()); }),
              AllOf(HasSubstr("colmap mapper failed (exit status 3): ERROR: cannot open it"),
                    HasSubstr("mapper.log")));
  EXPECT_EQ(RunMapper("echo 'Loading'; exit 1").last_line, "Loading");
}

TEST_F(ColmapProgramTest, TerminationBySignalIsReported) {
  // Background processes of a shell ignore Ctrl-C, and so do their children.
  std::signal(SIGINT, SIG_DFL);
  EXPECT_THAT(InputErrorOf([&] { RunMapper("kill -INT $$"); }), HasSubstr("was interrupted"));
  EXPECT_THAT(InputErrorOf([&] { RunMapper("echo busy; kill -KILL $$"); }),
              AllOf(HasSubstr("out of memory?"), HasSubstr("busy")));
}

TEST_F(ColmapProgramTest, ChildDoesNotOutliveAnException) {
  fake_.Set("do_mapper", "echo $$; exec sleep 100");
  std::string pid;
  EXPECT_THROW(ColmapProgram::Find().Run("mapper", {}, Log(),
                                         [&](std::string_view line) {
                                           pid = line;
                                           throw std::runtime_error("stop");
                                         }),
               std::runtime_error);
  ASSERT_FALSE(pid.empty());
  EXPECT_NE(kill(std::stoi(pid), 0), 0) << "process " << pid << " still runs";
}

TEST_F(ColmapProgramTest, UnwritableLogIsNamed) {
  fake_.Set("do_mapper", "echo one");
  EXPECT_THAT(InputErrorOf([&] {
                ColmapProgram::Find().Run("mapper", {}, scratch_.path() / "absent" / "x.log",
                                          [](std::string_view) {});
              }),
              HasSubstr("x.log"));
}

TEST(ParseProgress, ParsesOldAndNewLines) {
  const auto expect = [](const char* line, int done, int total) {
    const StepProgress progress = ParseProgress(line);
    EXPECT_EQ(progress.done, done) << line;
    EXPECT_EQ(progress.total, total) << line;
  };
  expect("Processed file [12/50]", 12, 50);
  expect("I20250101 10:00:00 12 feature_extraction.cc:258] Processed file [12/50]", 12, 50);
  expect("Matching block [2/3, 1/3] in 0.123s", 4, 9);
  expect("Matching image [3/120] in 0.1s", 3, 120);
  expect("Registering image #12 (34)", 34, 0);
  expect("I20261129 10:00:00 12 pairing.cc:310] Processing block [2/3, 1/3]", 4, 9);
  expect("Processing image [3/120]", 3, 120);
  expect("I20261129 10:00:00 1 sfm.cc:1] Registering image #7 (num_reg_frames=6)", 6, 0);
  expect("  => Image sees 123 / 456 points", 0, 0);
  expect("Processed file [99999999999999/1]", 0, 0);
  expect("", 0, 0);
}

}  // namespace
}  // namespace nerf::sfm
