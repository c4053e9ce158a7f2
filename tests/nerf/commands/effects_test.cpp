#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/image/image_io.h"
#include "tests/nerf/commands/run_program.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::RunNerf;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAreArray;

// Small captures that call for one effect each, and tiny runs on them.
class EffectsCommands : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::ScratchFolder;
    for (const char* scenario : {"exposure", "masks"}) {
      const auto made = RunNerf(
          fmt::format("sample {} --scenario {} --views 17 --width 64 --height 48 --samples 2",
                      Path(scenario), scenario));
      ASSERT_EQ(made.exit_status, 0) << made.output;
    }
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string Path(const std::string& name) { return (folder_->path() / name).string(); }

  static std::string Train(const std::string& capture, const std::string& run,
                           const std::string& flags) {
    return fmt::format(
        "train {}/truth/sparse -o {} --threads 2 --set train.steps=60 "
        "--set train.samples_per_batch=2048 --set encoding.log2_table_size=12 "
        "--set field.hidden_width=16 --set occupancy.resolution=32 {}",
        Path(capture), Path(run), flags);
  }

  static nlohmann::json Json(const std::string& file) {
    return nlohmann::json::parse(ReadWholeFile(Path(file)));
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
test::ScratchFolder* EffectsCommands::folder_ = nullptr;

TEST_F(EffectsCommands, InspectPrintsAVerdictForEachEffectWithItsEvidence) {
  const auto table = RunNerf("inspect " + Path("exposure/truth/sparse"));
  EXPECT_EQ(table.exit_status, 0);
  for (const char* effect :
       {"alpha", "hdr", "masks", "view_dependence", "background", "exposure", "robust",
        "depth_supervision", "pose_refinement", "anti_aliasing", "unbounded"}) {
    EXPECT_THAT(table.output, HasSubstr(effect));
  }
  EXPECT_THAT(table.output, HasSubstr("stops"));
  const auto json = RunNerf("inspect --json " + Path("exposure/truth/sparse"));
  const auto root = nlohmann::json::parse(json.output);
  EXPECT_EQ(root.at("verdicts").size(), 12u);
  EXPECT_EQ(root.at("exposure_stops").size(), 17u);
}

TEST_F(EffectsCommands, InspectReportsWhatPhotographsAloneShow) {
  const auto result = RunNerf("inspect " + Path("masks/images"));
  EXPECT_EQ(result.exit_status, 0) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("17 of 17 photographs have a mask"),
                                   HasSubstr("without poses"), HasSubstr("nerf poses")));
}

TEST_F(EffectsCommands, InspectWritesAPlotToAGivenFile) {
  const std::string inspect = "inspect " + Path("exposure/truth/sparse") + " --picture ";
  const auto result = RunNerf(inspect + Path("plot.png"));
  ASSERT_EQ(result.exit_status, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("exposure"));
  EXPECT_EQ(ReadImage(Path("plot.png"), false).channels, 3);

  ExpectRejected(inspect + Path("no-such-folder/plot.png"), HasSubstr("no-such-folder/plot.png"));
  ExpectRejected(inspect + Path("plot.rain"), HasSubstr("plot.rain"));
  EXPECT_FALSE(fs::exists(Path("no-such-folder")));
}

TEST_F(EffectsCommands, TrainSimulatesWhatTheCaptureCallsForAndReportsWhy) {
  const auto run = RunNerf(Train("exposure", "auto", ""));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("effects that the capture calls for"));
  EXPECT_FALSE(Json("auto/config.json").at("effects").at("exposure").is_null());
  EXPECT_TRUE(Json("auto/config.json").at("effects").at("masks").is_null());
  EXPECT_EQ(Json("auto/effects.json").at("verdicts").size(), 12u);
  EXPECT_GT(Json("auto/config.json").at("march").at("near_distance"), 0.1);

  const auto eval = RunNerf("eval " + Path("auto"));
  EXPECT_THAT(eval.output, HasSubstr("exposure fitted to its photograph"));
  EXPECT_TRUE(Json("auto/eval/eval.json").at("exposure_fitted"));

  // --exposure-of changes the image.
  const auto at = [&](const std::string& name, const std::string& flags) {
    const auto render =
        RunNerf("render " + Path("auto") + " --image view_001.png -o " + Path(name) + " " + flags);
    EXPECT_EQ(render.exit_status, 0) << render.output;
    return ReadImage(Path(name + "/view_001.png"), false).pixels;
  };
  EXPECT_NE(at("mean", ""), at("as", "--exposure-of view_002.png"));
  ExpectRejected("render " + Path("auto") + " --exposure-of nobody.png", HasSubstr("nobody.png"));
}

// One slightly transparent pixel per photograph: too few to be found by inspection, but a learned
// background does not allow any.
TEST_F(EffectsCommands, BackgroundIsTurnedOffForALittleAlpha) {
  const auto made = RunNerf("sample " + Path("sky") +
                            " --scenario background --views 17 --width 64 --height 48 --samples 2");
  ASSERT_EQ(made.exit_status, 0) << made.output;
  const std::string log = RunNerf("train " + Path("sky/truth/sparse") + " -o " + Path("clear") +
                                  " --threads 2 --set train.steps=20")
                              .output;
  ASSERT_FALSE(Json("clear/config.json").at("effects").at("background").is_null()) << log;
  for (const auto& entry : fs::recursive_directory_iterator(Path("sky"))) {
    if (entry.path().extension() != ".png") continue;
    const Image opaque = ReadImage(entry.path(), false);
    if (opaque.channels != 3 || opaque.width != 64) continue;
    Image image(opaque.width, opaque.height, 4);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      image.pixels[i] = i % 4 == 3 ? 1.0f : opaque.pixels[i / 4 * 3 + i % 4];
    }
    image.pixels[3] = 0.9f;
    WriteImage(entry.path(), image);
  }
  const auto run = RunNerf(Train("sky", "little", ""));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("some photographs have alpha"));
  const auto effects = Json("little/config.json").at("effects");
  EXPECT_TRUE(effects.at("background").is_null());
  EXPECT_FALSE(effects.at("unbounded").is_null());
}

TEST_F(EffectsCommands, RefinedPosesAreReportedAndWritten) {
  const auto run = RunNerf(Train("exposure", "refined", "--effects +pose_refinement"));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("cameras rotated by"));
  const auto frames = Json("refined/transforms.json").at("frames");
  const auto refined = Json("refined/refined_transforms.json").at("frames");
  ASSERT_EQ(refined.size(), frames.size());
  int moved = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    double change = 0;
    for (int k = 0; k < 12; ++k) {
      const auto at = [&](const nlohmann::json& frame) {
        return frame.at("transform_matrix").at(k / 4).at(k % 4).get<double>();
      };
      change = std::max(change, std::fabs(at(refined[i]) - at(frames[i])));
    }
    moved += change > 1e-9;  // more than by rounding
  }
  EXPECT_GT(moved, 10);
  EXPECT_LT(moved, 17);  // held-out photographs are not refined
  EXPECT_EQ(RunNerf("eval " + Path("refined")).exit_status, 0);
}

TEST_F(EffectsCommands, EvalMeasuresGainAndCostOfEachSimulatedEffect) {
  const auto run =
      RunNerf(Train("exposure", "worth", "--effects -view_dependence,+pose_refinement"));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  const std::string eval = "eval " + Path("worth") + " --effects --effects-steps ";
  const auto table = RunNerf(eval + "10");
  EXPECT_EQ(table.exit_status, 0) << table.output;
  EXPECT_THAT(table.output, AllOf(HasSubstr("gain dB"), HasSubstr("after 10 steps"),
                                  HasSubstr("pose_refinement: on the right halves")));

  const auto printed = RunNerf(eval + "200 --json");
  ASSERT_EQ(printed.exit_status, 0) << printed.output;
  const auto json = nlohmann::json::parse(printed.output);
  EXPECT_EQ(json, Json("worth/eval/effects_worth.json"));
  std::vector<std::string> measured;
  for (const auto& measurement : json.at("effects")) {
    const std::string effect = measurement.at("effect");
    measured.push_back(effect);
    EXPECT_EQ(measurement.at("on_halves"), effect == "pose_refinement");
    EXPECT_GT(measurement.at("seconds_a_step_with"), 0);
    // Exposures differ by up to a stop.
    if (effect == "exposure") {
      EXPECT_GT(measurement.at("psnr_with"), measurement.at("psnr_without"));
      EXPECT_GT(measurement.at("megabytes"), 0);
    }
  }
  EXPECT_THAT(measured,
              UnorderedElementsAreArray(
                  Json("worth/effects.json").at("simulated").get<std::vector<std::string>>()));

  const auto all = RunNerf(Train("exposure", "none-held-out", "--set data.test_every=0"));
  ASSERT_EQ(all.exit_status, 0) << all.output;
  ExpectRejected("eval --effects " + Path("none-held-out"), HasSubstr("is held out"));
}

TEST_F(EffectsCommands, DecisionsOfTheUserAreRespected) {
  const auto run = RunNerf(
      Train("exposure", "asked", "--effects -exposure,+robust --set march.near_distance=0.3"));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("as requested"));
  const auto effects = Json("asked/config.json").at("effects");
  EXPECT_EQ(Json("asked/config.json").at("march").at("near_distance"), 0.3);
  EXPECT_TRUE(effects.at("exposure").is_null());
  EXPECT_FALSE(effects.at("robust").is_null());
  ExpectRejected("render " + Path("asked") + " --exposure-of view_001.png",
                 HasSubstr("does not simulate exposures"));

  const auto configured = RunNerf(Train("exposure", "configured", "--effects config"));
  EXPECT_THAT(configured.output, Not(HasSubstr("effects that the capture calls for")));
  EXPECT_TRUE(Json("configured/config.json").at("effects").at("exposure").is_null());
  EXPECT_EQ(Json("configured/config.json").at("march").at("near_distance"), 0.05);

  WriteFileAtomically(Path("mine.json"), R"({"parent": "base", "effects": {"exposure": null}})");
  const auto pinned = RunNerf(Train("exposure", "pinned", "--config " + Path("mine.json")));
  EXPECT_EQ(pinned.exit_status, 0) << pinned.output;
  EXPECT_TRUE(Json("pinned/config.json").at("effects").at("exposure").is_null());
}

TEST_F(EffectsCommands, MasksAreFoundAndUsedInTrainingAndEvaluation) {
  const auto run = RunNerf(Train("masks", "masked", ""));
  ASSERT_EQ(run.exit_status, 0) << run.output;
  EXPECT_EQ(Json("masked/config.json").at("effects").at("masks").at("meaning"), "ignore");
  EXPECT_THAT(ReadWholeFile(Path("masked/transforms.json")), HasSubstr("mask_path"));
  EXPECT_EQ(RunNerf("eval " + Path("masked")).exit_status, 0);
}

TEST_F(EffectsCommands, InvalidRequestsAreRejected) {
  ExpectRejected(Train("exposure", "x", "--effects +rain"),
                 AllOf(HasSubstr("+rain"), HasSubstr("exposure")));
  ExpectRejected(Train("exposure", "x", "--effects exposure"), HasSubstr("+exposure"));
  ExpectRejected(Train("exposure", "x", "--set effects.rain={}"), HasSubstr("effects.rain"));
  ExpectRejected("sample " + Path("y") + " --scenario rain", HasSubstr("rain"));
  EXPECT_FALSE(fs::exists(Path("x")));

  const std::string masks = Path("masks/masks/view_003.png");
  const std::string before = ReadWholeFile(masks);
  WriteImage(masks, Image(8, 8, 3));
  ExpectRejected("inspect " + Path("masks/truth/sparse"),
                 AllOf(HasSubstr("view_003.png"), HasSubstr("8x8"), HasSubstr("64x48")));
  WriteFileAtomically(masks, before);
}

}  // namespace
}  // namespace nerf
