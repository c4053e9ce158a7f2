#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/nerf/commands/run_program.h"
#include "tests/support/scratch_folder.h"

namespace nerf::test {

// For tests of commands that take a run: `run`, a field of a small generated capture, trained until
// it has surfaces. Once for all tests of a fixture.
class SmallRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    const auto made =
        RunNerf("sample " + Path("sample") + " --views 20 --width 64 --height 48 --samples 1");
    ASSERT_EQ(made.exit_status, 0) << made.output;
    const auto trained =
        RunNerf("train " + Path("sample/truth/sparse") + " -o " + Path("run") +
                " --threads 2 --config fast --set train.steps=150 --effects config "
                "--representation field");
    ASSERT_EQ(trained.exit_status, 0) << trained.output;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string Path(const std::string& name) { return (folder_->path() / name).string(); }

  inline static ScratchFolder* folder_ = nullptr;
};

}  // namespace nerf::test
