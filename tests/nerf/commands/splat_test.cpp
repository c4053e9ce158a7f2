#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "nerf/image/image_io.h"
#include "tests/nerf/commands/small_run.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::RunNerf;
using testing::HasSubstr;

class SplatCommand : public test::SmallRun {
 protected:
  static test::ProgramResult Splat(const std::string& flags = "") {
    return RunNerf("splat " + Path("run") + " --set splats.count=3000 --set splats.steps=150 " +
                   flags);
  }
  static double PsnrWith(const std::string& with) {
    const auto eval = RunNerf("eval --json " + Path("run") + " --with " + with);
    EXPECT_EQ(eval.exit_status, 0) << eval.output;
    return nlohmann::json::parse(eval.output).at("psnr");
  }
  static std::string Bytes(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(SplatCommand, MakesGaussiansThatEvalAndRenderDraw) {
  const auto made = Splat();
  ASSERT_EQ(made.exit_status, 0) << made.output;
  EXPECT_THAT(made.output, HasSubstr("fitted 3000 Gaussians in 150 iterations"));
  EXPECT_THAT(made.output, HasSubstr("validation: Gaussians"));
  const double fitted = PsnrWith("splats");
  ASSERT_EQ(Splat("--set splats.steps=1").exit_status, 0);
  EXPECT_GT(fitted, PsnrWith("splats") + 1);
  const auto rendered = RunNerf("render " + Path("run") +
                                " --with splats --depth --opacity --surface -o " + Path("views"));
  ASSERT_EQ(rendered.exit_status, 0) << rendered.output;
  const Image picture = ReadImage(Path("views/view_000.png"), false);
  EXPECT_EQ(picture.width, 64);
  EXPECT_TRUE(fs::exists(Path("views/view_000.depth.exr")));
  EXPECT_TRUE(fs::exists(Path("views/view_000.median_depth.exr")));
  EXPECT_TRUE(fs::exists(Path("views/view_000.normal.exr")));
  const Image normals = ReadImage(Path("views/view_000.normal.png"), false);
  EXPECT_EQ(normals.width, 64);
  const auto of_field = RunNerf("render " + Path("run") + " --with field --surface");
  EXPECT_EQ(of_field.exit_status, 2);
  EXPECT_THAT(of_field.output, HasSubstr("--surface: median depth and normals are of Gaussians"));
}

TEST_F(SplatCommand, TrainingMakesThemWhereTheyAreAskedFor) {
  const auto trained =
      RunNerf("train " + Path("sample/truth/sparse") + " -o " + Path("both") +
              " --threads 2 --config fast --set train.steps=150 --effects config "
              "--representation splats --set splats.count=3000 --set splats.steps=100");
  ASSERT_EQ(trained.exit_status, 0) << trained.output;
  EXPECT_THAT(trained.output, HasSubstr("fitted 3000 Gaussians in 100 iterations"));
  const auto record = nlohmann::json::parse(Bytes(Path("both/representation.json")));
  const auto with = [](const std::string& flags) -> std::string {
    const auto eval = RunNerf("eval --json " + Path("both") + flags);
    EXPECT_EQ(eval.exit_status, 0) << eval.output;
    return nlohmann::json::parse(eval.output).at("with");
  };
  EXPECT_EQ(with(""), record.at("best").get<std::string>());
  EXPECT_EQ(with(" --with field"), "field");
  EXPECT_EQ(with(" --with splats"), "splats");
  // The ways to save time are those of the field.
  EXPECT_EQ(with(" --quality 0.5"), "field");
  const auto again = RunNerf("splat --resume " + Path("both"));
  EXPECT_EQ(again.exit_status, 2);
  EXPECT_THAT(again.output, HasSubstr("its fit has ended"));
  const auto changed = RunNerf("splat --resume --set splats.steps=5 " + Path("both"));
  EXPECT_EQ(changed.exit_status, 2);
  EXPECT_THAT(changed.output, HasSubstr("omit --set"));
}

// What is written for other programs is drawn as the run draws it.
TEST_F(SplatCommand, APlyFileIsWrittenAndDrawn) {
  ASSERT_EQ(Splat().exit_status, 0);
  const auto written = RunNerf("splat " + Path("run") + " --ply " + Path("scene.ply"));
  ASSERT_EQ(written.exit_status, 0) << written.output;
  EXPECT_THAT(written.output, HasSubstr("3000 Gaussians in"));
  const auto frames = nlohmann::json::parse(Bytes(Path("run/transforms.json")));
  nlohmann::json pose = {{"transform_matrix", frames.at("frames").at(0).at("transform_matrix")}};
  for (const char* key : {"fl_x", "fl_y", "cx", "cy", "w", "h"}) {
    pose[key] = frames.contains(key) ? frames[key] : frames["frames"][0].at(key);
  }
  std::ofstream(Path("pose.json")) << pose;
  const std::string flags = " --pose " + Path("pose.json") + " -o ";
  const auto of_run = RunNerf("render " + Path("run") + " --with splats" + flags + Path("a"));
  ASSERT_EQ(of_run.exit_status, 0) << of_run.output;
  const auto of_file = RunNerf("render " + Path("scene.ply") + flags + Path("b"));
  ASSERT_EQ(of_file.exit_status, 0) << of_file.output;
  const Image a = ReadImage(Path("a/pose.png"), false), b = ReadImage(Path("b/pose.png"), false);
  ASSERT_EQ(a.width, 64);
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  double difference = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference += std::abs(a.pixels[i] - b.pixels[i]) / static_cast<double>(a.pixels.size());
  }
  EXPECT_LT(difference, 2e-3);
  const auto no_pose = RunNerf("render " + Path("scene.ply") + " -o " + Path("c"));
  EXPECT_EQ(no_pose.exit_status, 2);
  EXPECT_THAT(no_pose.output, HasSubstr("a PLY file has no cameras"));
  EXPECT_EQ(RunNerf("render " + Path("none.ply") + flags + Path("c")).exit_status, 2);
  EXPECT_FALSE(fs::exists(Path("c")));
}

TEST_F(SplatCommand, ADamagedRecordIsNamed) {
  ASSERT_EQ(Splat().exit_status, 0);
  std::ofstream(Path("run/representation.json")) << "{";
  const auto eval = RunNerf("eval " + Path("run"));
  EXPECT_EQ(eval.exit_status, 2);
  EXPECT_THAT(eval.output, HasSubstr("representation.json"));
  EXPECT_EQ(RunNerf("eval " + Path("run") + " --with field").exit_status, 0);
  fs::remove(Path("run/representation.json"));
}

TEST_F(SplatCommand, TheSameSeedGivesTheSameBits) {
  const auto written = [](const std::string& ply) {
    EXPECT_EQ(Splat("--threads 1").exit_status, 0);
    EXPECT_EQ(RunNerf("splat " + Path("run") + " --ply " + Path(ply)).exit_status, 0);
    return Bytes(Path(ply));
  };
  const std::string once = written("once.ply");
  EXPECT_FALSE(once.empty());
  EXPECT_TRUE(once == written("again.ply"));  // not printed where it fails
}

TEST_F(SplatCommand, AFileOfTheSizeThatWasAskedForIsWritten) {
  const auto made = RunNerf("splat " + Path("run") + " --set splats.steps=2 --megabytes 0.5");
  ASSERT_EQ(made.exit_status, 0) << made.output;
  ASSERT_EQ(RunNerf("splat " + Path("run") + " --ply " + Path("small.ply")).exit_status, 0);
  EXPECT_LT(fs::file_size(Path("small.ply")), 502000);  // with its header
  EXPECT_GT(fs::file_size(Path("small.ply")), 490000);
  const auto tiny = RunNerf("splat " + Path("run") + " --megabytes 0.001");
  EXPECT_EQ(tiny.exit_status, 2);
  EXPECT_THAT(tiny.output, HasSubstr("--megabytes 0.001: would be 4 Gaussians"));
}

TEST_F(SplatCommand, AFrameTimeLimitsTheNumberOfGaussians) {
  const std::string fit = "splat " + Path("run") + " --set splats.steps=64 --set splats.count=2000";
  const auto slow = RunNerf(fit + " --seconds-per-frame 100");
  EXPECT_THAT(slow.output, HasSubstr("fitted 2000 Gaussians"));
  EXPECT_THAT(slow.output, HasSubstr("a frame takes"));
  const auto fast = RunNerf(fit + " --seconds-per-frame 1e-9");
  EXPECT_THAT(fast.output, HasSubstr("fitted 16 Gaussians"));
  EXPECT_EQ(RunNerf("splat " + Path("run") + " --seconds-per-frame 0").exit_status, 2);
  EXPECT_EQ(RunNerf("splat " + Path("run") + " --seconds-per-frame nan").exit_status, 2);
  EXPECT_EQ(RunNerf("splat " + Path("run") + " --megabytes 0").exit_status, 2);
}

TEST_F(SplatCommand, WhatCannotBeDoneIsNamed) {
  fs::remove(Path("run/splats.nerf"));
  const auto without = RunNerf("render " + Path("run") + " --with splats -o " + Path("none"));
  EXPECT_EQ(without.exit_status, 2);
  EXPECT_THAT(without.output, HasSubstr("make Gaussians first: nerf splat"));
  EXPECT_FALSE(fs::exists(Path("none")));
  ASSERT_EQ(Splat().exit_status, 0);
  const auto coarse = RunNerf("render " + Path("run") + " --with splats --quality 0.5");
  EXPECT_EQ(coarse.exit_status, 2);
  EXPECT_THAT(coarse.output, HasSubstr("always drawn exactly"));
  const auto effects = RunNerf("eval " + Path("run") + " --with splats --effects");
  EXPECT_EQ(effects.exit_status, 2);
  EXPECT_THAT(effects.output, HasSubstr("--effects"));
  const auto other = Splat("--set train.seed=7");
  EXPECT_EQ(other.exit_status, 2);
  EXPECT_THAT(other.output, HasSubstr("keys of splats"));
  const auto key = Splat("--set splats.cuont=5");
  EXPECT_EQ(key.exit_status, 2);
  EXPECT_THAT(key.output, HasSubstr("splats.cuont"));
  EXPECT_EQ(RunNerf("splat " + Path("nowhere")).exit_status, 2);
  std::ofstream(Path("run/splats.nerf")) << "damaged";
  const auto damaged = RunNerf("eval " + Path("run") + " --with splats");
  EXPECT_EQ(damaged.exit_status, 2);
  EXPECT_THAT(damaged.output, HasSubstr("splats.nerf"));
}

}  // namespace
}  // namespace nerf
