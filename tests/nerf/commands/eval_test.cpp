#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/nerf/commands/run_program.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using test::RunNerf;
using testing::ElementsAre;
using testing::HasSubstr;

// A short run on a generated capture, in which every eighth photograph is held out for testing and
// none for validation.
class EvalCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::ScratchFolder;
    const auto made =
        RunNerf("sample " + Path("sample") + " --views 10 --width 48 --height 36 --samples 1");
    ASSERT_EQ(made.exit_status, 0) << made.output;
    const auto trained =
        RunNerf("train " + Path("sample/truth/transforms.json") + " -o " + Path("run") +
                " --threads 2 --set train.steps=20 --set train.samples_per_batch=2048 "
                "--set encoding.log2_table_size=12 --set occupancy.resolution=32");
    ASSERT_EQ(trained.exit_status, 0) << trained.output;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string Path(const std::string& name) { return (folder_->path() / name).string(); }

  static std::vector<std::string> EvaluatedImages(const std::string& flags) {
    const auto eval = RunNerf("eval --json " + Path("run") + flags);
    EXPECT_EQ(eval.exit_status, 0) << eval.output;
    const auto json = nlohmann::json::parse(eval.output);
    std::vector<std::string> names;
    for (const auto& image : json.at("images")) names.push_back(image.at("name"));
    return names;
  }

  inline static test::ScratchFolder* folder_ = nullptr;
};

TEST_F(EvalCommand, ScoresExactlyTheImagesOfTheSplit) {
  EXPECT_THAT(EvaluatedImages(""), ElementsAre("view_000.png", "view_008.png"));
  EXPECT_THAT(EvaluatedImages(" --split test"), ElementsAre("view_000.png", "view_008.png"));
  EXPECT_THAT(EvaluatedImages(" --split train"),
              ElementsAre("view_001.png", "view_002.png", "view_003.png", "view_004.png",
                          "view_005.png", "view_006.png", "view_007.png", "view_009.png"));
}

TEST_F(EvalCommand, RejectsSplitsWithoutImages) {
  const auto empty = RunNerf("eval --split validation " + Path("run"));
  EXPECT_EQ(empty.exit_status, 2) << empty.output;
  EXPECT_THAT(empty.output, HasSubstr("no validation images; choose another --split"));
  const auto unknown = RunNerf("eval --split all " + Path("run"));
  EXPECT_EQ(unknown.exit_status, 2) << unknown.output;
  EXPECT_THAT(unknown.output, HasSubstr("--split: all not in"));
}

}  // namespace
}  // namespace nerf
