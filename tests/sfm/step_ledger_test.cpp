#include "sfm/step_ledger.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/input_error_of.h"
#include "tests/support/photo_files.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

using State = StepLedger::State;
using nerf::test::FileBytes;
using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nlohmann::json;

TEST(StepLedger, StatesSurviveInTheFile) {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "steps.json";
  const json inputs = {"OPENCV", 1600};
  {
    StepLedger ledger(file);
    EXPECT_EQ(ledger.StateOf("features", inputs), State::kNew);
    ledger.Begin("features", inputs);
  }
  {
    StepLedger ledger(file);
    EXPECT_EQ(ledger.StateOf("features", inputs), State::kBegun);
    ledger.Finish("features", 1.5);
  }
  const StepLedger ledger(file);
  EXPECT_EQ(ledger.StateOf("features", inputs), State::kDone);
  EXPECT_EQ(ledger.StateOf("features", {"OPENCV", 800}), State::kChanged);
  EXPECT_EQ(ledger.Seconds("features"), 1.5);
  EXPECT_EQ(ledger.Seconds("matches"), 0);
}

TEST(StepLedger, BeginningAStepRemovesThoseAfterIt) {
  const ScratchFolder scratch;
  StepLedger ledger(scratch.path() / "steps.json");
  for (const char* step : {"features", "matches", "mapper"}) {
    ledger.Begin(step, 1);
    ledger.Finish(step, 1);
  }
  ledger.Begin("matches", 1);
  EXPECT_EQ(ledger.StateOf("features", 1), State::kDone);
  EXPECT_EQ(ledger.StateOf("matches", 1), State::kBegun);
  EXPECT_EQ(ledger.StateOf("mapper", 1), State::kNew);
}

TEST(StepLedger, DamagedFileCountsAsNoStepDone) {
  const ScratchFolder scratch;
  StepLedger whole(scratch.path() / "steps.json");
  whole.Begin("features", 1);
  whole.Finish("features", 1);
  const std::string bytes = FileBytes(scratch.path() / "steps.json");
  for (const std::string& damaged :
       {bytes.substr(0, bytes.size() / 2), std::string("{}"), std::string("[1, null]"),
        std::string(R"([{"step": 5, "inputs": 1}])"), std::string()}) {
    const StepLedger ledger(scratch.Write("damaged.json", damaged));
    EXPECT_EQ(ledger.StateOf("features", 1), State::kNew) << damaged;
  }
}

TEST(StepLedger, NamesInInvalidUtf8CanBeWritten) {
  const ScratchFolder scratch;
  StepLedger ledger(scratch.path() / "steps.json");
  ledger.Begin("images", {"caf\xe9.jpg"});
  EXPECT_THAT(FileBytes(scratch.path() / "steps.json"), testing::HasSubstr("caf"));
}

TEST(StepLedger, UnwritableFileIsNamed) {
  const ScratchFolder scratch;
  StepLedger ledger(scratch.path() / "absent" / "steps.json");
  EXPECT_THAT(InputErrorOf([&] { ledger.Begin("features", 1); }), testing::HasSubstr("steps.json"));
}

}  // namespace
}  // namespace nerf::sfm
