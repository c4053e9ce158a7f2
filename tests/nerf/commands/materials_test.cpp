#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
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
  EXPECT_THAT(made.output, HasSubstr("a light is not known"));
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
  EXPECT_THAT(own.output, HasSubstr("1 picture at +0.00 stops"));
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
  is_refused(Materials("--set roughness=1"), "materials.roughness");
  is_refused(Materials("--set points=many"), "materials.points must be");
  is_refused(Materials("--set points=0"), "materials.points");
  is_refused(Materials("--environment nowhere.hdr"), "nowhere.hdr");
  is_refused(RunNerf("materials " + Path("sample")), "contains no checkpoint.nerf");
  is_refused(RunNerf("relight " + Path("run") + " --environment D65 --truth x.exr"),
             "--truth, --lights chrome and --encoding are of light-stage captures");
  is_refused(RunNerf("relight " + Path("run")), "give --environment, or --lights");
  is_refused(RunNerf("relight " + Path("sample") + " --environment D65 --bounces 1"),
             "is no trained run");
}

// A field, and materials after it.
TEST_F(MaterialsCommand, TrainFindsThemAfterTheField) {
  const std::string flags =
      " --threads 2 --config fast --set train.steps=60 --effects config --representation field "
      "--materials --set materials.steps=4 --set materials.surface_resolution=32 --set "
      "materials.directions=64 --set materials.points=64 --set materials.specular=off";
  const auto trained =
      RunNerf("train " + Path("sample/truth/sparse") + " -o " + Path("with") + flags);
  ASSERT_EQ(trained.exit_status, 0) << trained.output;
  EXPECT_THAT(trained.output, HasSubstr("light: shadows"));
  EXPECT_THAT(trained.output, HasSubstr("found materials of a surface"));
  EXPECT_TRUE(fs::exists(Path("with/materials.nerf")));
  EXPECT_TRUE(fs::exists(Path("with/environment.exr")));
  // There is nothing to resume, and the file stays.
  const auto before = fs::last_write_time(Path("with/materials.nerf"));
  const auto resumed = RunNerf("train --resume -o " + Path("with") + " --threads 2");
  EXPECT_EQ(resumed.exit_status, 0) << resumed.output;
  EXPECT_EQ(fs::last_write_time(Path("with/materials.nerf")), before);
  const auto ended = RunNerf("materials --resume " + Path("with"));
  EXPECT_EQ(ended.exit_status, 2);
  EXPECT_THAT(ended.output, HasSubstr("its fit has ended"));
}

TEST_F(MaterialsCommand, ChannelsEditsAndLights) {
  ASSERT_EQ(Materials().exit_status, 0);
  std::ofstream(Path("edits.json")) << R"([{"albedo": {"set": [0.1, 0.2, 0.9]}}])";
  const auto channels =
      RunNerf("render " + Path("run") + " --image view_000.png --channel " +
              "normal,albedo,visibility --edit " + Path("edits.json") + " -o " + Path("channels"));
  ASSERT_EQ(channels.exit_status, 0) << channels.output;
  const Image albedo = ReadImage(Path("channels/view_000_albedo.exr"), false);
  const Image normal = ReadImage(Path("channels/view_000_normal.exr"), false);
  ASSERT_EQ(albedo.channels, 4);
  int opaque = 0;
  for (std::size_t p = 0; p < albedo.pixels.size() / 4; ++p) {
    if (albedo.pixels[4 * p + 3] < 0.99f) continue;
    ++opaque;
    EXPECT_NEAR(albedo.pixels[4 * p + 2], 0.9f, 1e-3f);
    EXPECT_NEAR(Eigen::Vector3f(&normal.pixels[4 * p]).norm(), 1, 1e-3f);
  }
  EXPECT_GT(opaque, 100);

  std::ofstream(Path("lights.json")) << R"({"lights": {
      "sun": {"suns": [{"direction": [0, 0, 1]}]}, "sky": {"environment": "D65"}}})";
  const auto relit = RunNerf("relight " + Path("run") + " --image view_000.png --lights " +
                             Path("lights.json") + " --background map -o " + Path("lit"));
  ASSERT_EQ(relit.exit_status, 0) << relit.output;
  EXPECT_TRUE(fs::exists(Path("lit/sun/view_000.png")));
  EXPECT_TRUE(fs::exists(Path("lit/sky/view_000.exr")));

  // Without a path, the frames of a film are of an environment that turns.
  const auto turned =
      RunNerf("relight " + Path("run") + " --environment D65 --frames 3 -o " + Path("turned"));
  ASSERT_EQ(turned.exit_status, 0) << turned.output;
  EXPECT_TRUE(fs::exists(Path("turned/film.mp4")));

  std::ofstream(Path("edits.json")) << R"([{"box": {"min": [90, 90, 90], "max": [91, 91, 91]}}])";
  const auto empty =
      RunNerf("relight " + Path("run") + " --environment D65 --edit " + Path("edits.json"));
  EXPECT_EQ(empty.exit_status, 2);
  EXPECT_THAT(empty.output, HasSubstr("holds nothing of the surface"));
}

TEST_F(MaterialsCommand, EffectsOfLightAreMeasuredWithThoseOfTheField) {
  ASSERT_EQ(Materials("--set shadows=on --set bounces=on --set specular=on").exit_status, 0);
  const auto measured = RunNerf("eval " + Path("run") + " --effects --effects-steps 10");
  ASSERT_EQ(measured.exit_status, 0) << measured.output;
  for (const char* effect :
       {"view_dependence", "effect of light", "shadows", "bounces", "specular"}) {
    EXPECT_THAT(measured.output, HasSubstr(effect));
  }
}

TEST_F(MaterialsCommand, TruthOfOtherViewsOrOfAnotherSizeIsNamed) {
  ASSERT_EQ(Materials().exit_status, 0);
  const auto compare = [](const std::string& folder) {
    return RunNerf("eval " + Path("run") + " --truth " + Path(folder));
  };
  fs::create_directories(Path("truth/other_000"));
  WriteImage(Path("truth/other_000/albedo.png"), Image(8, 8, 4));
  EXPECT_THAT(compare("nowhere").output, HasSubstr("is not a folder"));
  EXPECT_THAT(compare("truth").output, HasSubstr("none of the held-out views"));
  fs::create_directories(Path("truth/view_000"));
  WriteImage(Path("truth/view_000/albedo.png"), Image(8, 8, 4));
  EXPECT_THAT(compare("truth").output, HasSubstr("has 8x8 pixels, the held-out view 64x48"));
  // Of the right size: what is grey everywhere is found as well as a picture of it.
  Image grey(64, 48, 4);
  std::ranges::fill(grey.pixels, 1.0f);
  WriteImage(Path("truth/view_000/albedo.png"), grey);
  const auto compared = compare("truth");
  EXPECT_EQ(compared.exit_status, 0) << compared.output;
  EXPECT_THAT(compared.output, HasSubstr("albedo, dB"));
  EXPECT_TRUE(fs::exists(Path("run/eval/truth.json")));
}

}  // namespace
}  // namespace nerf
