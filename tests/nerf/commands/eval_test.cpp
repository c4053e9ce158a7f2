#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
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

TEST_F(EvalCommand, PrintsTheResolutionAndCanChangeIt) {
  EXPECT_THAT(RunNerf("eval " + Path("run")).output, HasSubstr("48 x 36 pixels"));
  const auto half = RunNerf("eval --downscale 2 --json " + Path("run"));
  const auto json = nlohmann::json::parse(half.output);
  EXPECT_EQ(json.at("width"), 24);
  EXPECT_EQ(json.at("height"), 18);
  EXPECT_EQ(json.at("downscale"), 2);
  EXPECT_EQ(RunNerf("eval --downscale 0 " + Path("run")).exit_status, 2);
}

TEST_F(EvalCommand, OfLostPhotographsIsOneLine) {
  const auto images = folder_->path() / "sample/images", lost = folder_->path() / "lost";
  std::filesystem::rename(images, lost);
  const auto eval = RunNerf("eval " + Path("run"));
  std::filesystem::rename(lost, images);
  EXPECT_EQ(eval.exit_status, 2);
  EXPECT_THAT(eval.output, HasSubstr("none of the 2 test images could be read; the first:"));
  EXPECT_EQ(std::ranges::count(eval.output, '\n'), 1) << eval.output;
}

// left/1.png and left_1.png, 2.png and 2.jpg: each held-out view has a picture of its own.
TEST_F(EvalCommand, ViewsOfImagesWithAlikeNamesAreAllRendered) {
  test::ScratchFolder copy;
  std::filesystem::copy(folder_->path() / "run", copy.path() / "run",
                        std::filesystem::copy_options::recursive);
  auto poses = nlohmann::json::parse(std::ifstream(copy.path() / "run/transforms.json"));
  const std::vector<std::string> names = {"left/1.png", "left_1.png", "2.png", "2.jpg"};
  poses["test_filenames"] = nlohmann::json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    poses["frames"][i]["file_path"] = names[i];
    poses["frames"][i]["source_name"] = names[i];
    poses["test_filenames"].push_back(names[i]);
  }
  poses["train_filenames"] = nlohmann::json::array();
  std::ofstream(copy.path() / "run/transforms.json") << poses;
  const auto render = RunNerf("render --quality 0 " + (copy.path() / "run").string());
  EXPECT_EQ(render.exit_status, 0) << render.output;
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(copy.path() / "run/renders/held-out")) {
    files.push_back(entry.path().filename());
  }
  EXPECT_THAT(files, testing::UnorderedElementsAre("left_1_png.png", "left_1_png_2.png",
                                                   "2_png.png", "2_jpg.png"));
  const auto one = RunNerf("render --quality 0 --image 2_jpg " + (copy.path() / "run").string());
  EXPECT_EQ(one.exit_status, 0) << one.output;
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
