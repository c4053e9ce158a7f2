#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "nerf/image/image_io.h"
#include "tests/nerf/commands/small_run.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::RunNerf;
using testing::HasSubstr;

class MaterialsCommand : public test::SmallRun {
 protected:
  static test::ProgramResult Materials(const std::string& flags = "") {
    return RunNerf("materials " + Path("run") +
                   " --steps 5 --threads 2 --set surface_resolution=40 --set directions=64 " +
                   flags);
  }
};

TEST_F(MaterialsCommand, FindsThemAndRelightsTheRun) {
  const auto none = RunNerf("relight " + Path("run") + " --environment D65");
  EXPECT_EQ(none.exit_status, 2);
  EXPECT_THAT(none.output, HasSubstr("find materials first: nerf materials"));

  const auto made = Materials();
  ASSERT_EQ(made.exit_status, 0) << made.output;
  EXPECT_THAT(made.output, HasSubstr("5 steps"));
  EXPECT_THAT(made.output, HasSubstr("the light is not known"));
  EXPECT_TRUE(fs::exists(Path("run/materials.nerf")));
  const Image light = ReadImage(Path("run/environment.exr"), false);
  EXPECT_EQ(light.width, 64);
  EXPECT_EQ(light.height, 32);

  const auto relit = RunNerf("relight " + Path("run") + " --environment D65");
  ASSERT_EQ(relit.exit_status, 0) << relit.output;
  const Image picture = ReadImage(Path("run/relit/D65/view_000.png"), false);
  EXPECT_EQ(picture.width, 64);
  const Image linear = ReadImage(Path("run/relit/D65/view_000.exr"), false);
  EXPECT_EQ(linear.encoding, ColorEncoding::kLinear);
  // The found light as a map, one view, at an exposure that is asked for.
  const auto own =
      RunNerf("relight " + Path("run") + " --environment " + Path("run/environment.exr") +
              " --image view_000.png --rotate 90 --exposure 0 --bounces 0 -o " + Path("own"));
  ASSERT_EQ(own.exit_status, 0) << own.output;
  EXPECT_THAT(own.output, HasSubstr("1 view at +0.00 stops"));
  EXPECT_TRUE(fs::exists(Path("own/view_000.png")));
}

TEST_F(MaterialsCommand, ALightThatIsGivenIsTakenAsItIs) {
  const auto made = Materials("--environment blackbody:3200 --exposure 1");
  ASSERT_EQ(made.exit_status, 0) << made.output;
  EXPECT_THAT(made.output, testing::Not(HasSubstr("not known")));
  const Image light = ReadImage(Path("run/environment.exr"), false);
  EXPECT_GT(light.pixels[0], 1.5f * light.pixels[2]);  // warm
}

TEST_F(MaterialsCommand, WrongFlagsAreNamed) {
  const auto is_refused = [](const test::ProgramResult& result, const std::string& text) {
    EXPECT_EQ(result.exit_status, 2);
    EXPECT_THAT(result.output, HasSubstr(text));
  };
  is_refused(Materials("--set roughness=1"), "--set roughness=1: use KEY=VALUE; the keys are");
  is_refused(Materials("--set points=many"), "--set points=many: use a number");
  is_refused(Materials("--set points=0"), "materials.points");
  is_refused(Materials("--environment nowhere.hdr"), "nowhere.hdr");
  is_refused(RunNerf("materials " + Path("sample")), "contains no checkpoint.nerf");
  is_refused(RunNerf("relight " + Path("run") + " --environment D65 --truth x.exr"),
             "--truth, --lights and --encoding are of light-stage captures");
  is_refused(RunNerf("relight " + Path("run") + " --environment D65 --frames 3"), "give --path");
  is_refused(RunNerf("relight " + Path("sample") + " --environment D65 --bounces 1"),
             "is no trained run");
}

}  // namespace
}  // namespace nerf
