#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/nerf/commands/run_program.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(RelightCommand, RelightsWhatSamplePhotographed) {
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

TEST(LightStageFlags, AloneAreRefused) {
  const auto result = test::RunNerf("sample nowhere --environment map.hdr");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("--light-stage"));
  EXPECT_FALSE(std::filesystem::exists("nowhere"));
}

TEST(RelightCommand, RefusesWhatIsNoLight) {
  const test::ScratchFolder scratch;
  const std::string stage = (scratch.path() / "stage").string();
  ASSERT_EQ(test::RunNerf("sample " + stage + " --light-stage 3 --width 8 --height 6").exit_status,
            0);
  const auto result = test::RunNerf("relight " + stage + " --environment candle");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("candle"));
  EXPECT_THAT(result.output, HasSubstr("D65"));
}

TEST(RelightCommand, RefusesAFolderWithoutLights) {
  const test::ScratchFolder scratch;
  for (const char* name : {"1.ppm", "2.ppm", "3.ppm"}) scratch.WriteImage(name, 8, 6);
  const auto result = test::RunNerf("relight " + scratch.path().string() + " --environment D65");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("lights.txt"));
}

TEST(PhotometricStereoCommand, RefusesCoplanarLightsAndLeavesNothing) {
  const test::ScratchFolder scratch;
  for (const char* name : {"1.ppm", "2.ppm", "3.ppm"}) scratch.WriteImage(name, 8, 6);
  scratch.Write("lights.txt", "0 0 1\n1 0 1\n-1 0 1\n");
  const std::string out = (scratch.path() / "out").string();
  const auto result = test::RunNerf("photometric-stereo " + scratch.path().string() + " -o " + out);
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.output, HasSubstr("one plane"));
  EXPECT_FALSE(std::filesystem::exists(out));
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
