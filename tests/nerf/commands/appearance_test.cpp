#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/nerf/commands/run_program.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(RelightCommand, RelightsAGeneratedLightStage) {
  const test::ScratchFolder scratch;
  const std::string stage = (scratch.path() / "stage").string();
  const auto sample = test::RunNerf("sample " + stage + " --light-stage 8 --width 32 --height 18");
  ASSERT_EQ(sample.exit_status, 0) << sample.output;
  EXPECT_THAT(sample.output, HasSubstr("8 images"));
  const std::string out = (scratch.path() / "out").string();
  const auto relit = test::RunNerf("relight " + stage + " --environment blackbody:3200 -o " + out);
  ASSERT_EQ(relit.exit_status, 0) << relit.output;
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "out/relit.png"));
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "out/relit.exr"));
}

TEST(LightStageFlags, RequireLightStage) {
  const auto result = test::RunNerf("sample nowhere --environment map.hdr");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("--light-stage"));
  EXPECT_FALSE(std::filesystem::exists("nowhere"));
}

TEST(LightStageFlags, RejectFlagsThatWouldBeIgnored) {
  for (const char* flags :
       {"--light-stage 0", "--light-stage 3 --views 5", "--light-stage 3 --samples 4",
        "--light-stage 3 --seed 1", "--light-stage 3 --scenario exposure",
        "--light-stage 3 --calls-for exposure", "--light-stage 3 --paths 8"}) {
    const auto result = test::RunNerf(std::string("sample nowhere ") + flags);
    EXPECT_EQ(result.exit_status, 2) << flags;
    EXPECT_THAT(result.output, HasSubstr("--")) << flags;
    EXPECT_FALSE(std::filesystem::exists("nowhere")) << flags;
  }
}

// A capture with three lights.
class SmallStage : public testing::Test {
 protected:
  SmallStage() {
    EXPECT_EQ(
        test::RunNerf("sample " + stage_ + " --light-stage 3 --width 8 --height 6").exit_status, 0);
  }
  test::ProgramResult Relight(const std::string& flags) const {
    return test::RunNerf("relight " + stage_ + " --environment D65 -o " + out_ + " " + flags);
  }

  test::ScratchFolder scratch_;
  std::string stage_ = (scratch_.path() / "stage").string();
  std::string out_ = (scratch_.path() / "out").string();
};

TEST_F(SmallStage, RejectsNumbersOutOfRangeAndWritesNothing) {
  for (const char* flags : {"--rotate nan", "--rotate 1e300", "--rotate inf", "--exposure nan",
                            "--exposure inf", "--exposure 1000", "--frames -1", "--memory-mb 0"}) {
    const auto result = Relight(flags);
    EXPECT_EQ(result.exit_status, 2) << flags;
    EXPECT_THAT(result.output, HasSubstr(std::string(flags).substr(0, 8))) << flags;
    EXPECT_FALSE(std::filesystem::exists(out_)) << flags;
  }
}

TEST_F(SmallStage, RejectsATruthOfAnotherSizeBeforeRelighting) {
  scratch_.WriteImage("truth.ppm", 9, 6);
  const auto result = Relight("--truth " + (scratch_.path() / "truth.ppm").string());
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("9 x 6"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(SmallStage, RejectsFewerThanThreeLightsAndBlackImages) {
  for (const char* name : {"light_0000.exr", "light_0001.exr", "light_0002.exr"}) {
    scratch_.Write(std::filesystem::path("stage") / name,
                   "P6\n8 6\n255\n" + std::string(144, '\0'));
  }
  const auto dark = Relight("");
  EXPECT_EQ(dark.exit_status, 2);
  EXPECT_THAT(dark.output, HasSubstr("black"));
  std::filesystem::remove(scratch_.path() / "stage/light_0002.exr");
  scratch_.Write("stage/lights.txt", "0 0 1\n1 0 1\n");
  const auto few = Relight("");
  EXPECT_EQ(few.exit_status, 2);
  EXPECT_THAT(few.output, HasSubstr("2 lights"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(SmallStage, ReportsTheShareOfLightFromDirectionsWithoutLights) {
  EXPECT_THAT(Relight("").output, Not(HasSubstr("left out")));
  scratch_.Write("stage/lights.txt", "0 0 1\n0.5 0 1\n0 0.5 1\n");
  const auto frontal = Relight("");
  EXPECT_EQ(frontal.exit_status, 0);
  EXPECT_THAT(frontal.output, HasSubstr("left out"));
}

TEST(RelightCommand, RejectsAnUnknownLight) {
  const test::ScratchFolder scratch;
  const std::string stage = (scratch.path() / "stage").string();
  ASSERT_EQ(test::RunNerf("sample " + stage + " --light-stage 3 --width 8 --height 6").exit_status,
            0);
  const auto result = test::RunNerf("relight " + stage + " --environment candle");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("candle"));
  EXPECT_THAT(result.output, HasSubstr("D65"));
}

TEST(RelightCommand, RejectsAFolderWithoutLights) {
  const test::ScratchFolder scratch;
  for (const char* name : {"1.ppm", "2.ppm", "3.ppm"}) scratch.WriteImage(name, 8, 6);
  const auto result = test::RunNerf("relight " + scratch.path().string() + " --environment D65");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("lights.txt"));
}

TEST(PhotometricStereoCommand, RejectsCoplanarLightsAndWritesNothing) {
  const test::ScratchFolder scratch;
  for (const char* name : {"1.ppm", "2.ppm", "3.ppm"}) scratch.WriteImage(name, 8, 6);
  scratch.Write("lights.txt", "0 0 1\n1 0 1\n-1 0 1\n");
  const std::string out = (scratch.path() / "out").string();
  const auto result = test::RunNerf("photometric-stereo " + scratch.path().string() + " -o " + out);
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("one plane"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(PhotometricStereoCommand, RejectsNumbersOutOfRange) {
  const test::ScratchFolder scratch;
  for (const char* name : {"1.ppm", "2.ppm", "3.ppm"}) scratch.WriteImage(name, 8, 6);
  scratch.Write("lights.txt", "0 0 1\n1 0 1\n0 1 1\n");
  const std::string out = (scratch.path() / "out").string();
  for (const char* flags : {"--memory-mb 0", "--dark nan", "--tolerance nan", "--residual nan"}) {
    const auto result =
        test::RunNerf("photometric-stereo " + scratch.path().string() + " -o " + out + " " + flags);
    EXPECT_EQ(result.exit_status, 2) << flags;
    EXPECT_THAT(result.output, HasSubstr(std::string(flags).substr(0, 6))) << flags;
    EXPECT_FALSE(std::filesystem::exists(out)) << flags;
  }
}

// Run twice from within the folder of the data set.
TEST(PhotometricStereoCommand, DoesNotReadItsResultsAsInput) {
  const test::ScratchFolder scratch;
  for (const char* name : {"ph/cup/1.ppm", "ph/cup/2.ppm", "ph/cup/3.ppm"}) {
    scratch.WriteImage(name, 8, 6);
  }
  scratch.Write("ph/lights.txt", "0 0 1\n1 0 1\n0 1 1\n");
  const std::string within = "cd " + (scratch.path() / "ph").string() + " && ";
  for (int run = 0; run < 2; ++run) {
    const auto result = test::RunNerf("photometric-stereo .", within);
    EXPECT_EQ(result.exit_status, 0) << result.output;
  }
  EXPECT_EQ(test::RunNerf("photometric-stereo . -o .", within).exit_status, 2);
}

TEST(PhotometricStereoCommand, WritesItsMaps) {
  const test::ScratchFolder scratch;
  for (const char* name : {"1.ppm", "2.ppm", "3.ppm"}) scratch.WriteImage(name, 8, 6);
  scratch.Write("lights.txt", "0 0 1\n1 0 1\n0 1 1\n");
  const std::string out = (scratch.path() / "out").string();
  const auto result = test::RunNerf("photometric-stereo " + scratch.path().string() + " -o " + out);
  ASSERT_EQ(result.exit_status, 0) << result.output;
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "out/depth.ply"));
  EXPECT_THAT(result.output, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace nerf
