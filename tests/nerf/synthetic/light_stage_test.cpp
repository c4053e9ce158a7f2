#include "nerf/synthetic/light_stage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

#include "nerf/capture/relight.h"
#include "nerf/image/image_io.h"
#include "nerf/image/image_metrics.h"
#include "nerf/material/lambert.h"
#include "nerf/material/merl.h"
#include "nerf/material/microfacet.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/smooth_environment.h"

namespace nerf::synthetic {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

// The weighted sum of images under one light each is the subject under the environment.
TEST(LightStage, RelightingMatchesDirectRendering) {
  const auto map = std::make_shared<EnvironmentMap>(test::SmoothEnvironment());
  const StageCamera camera = LightStageCamera(48, 27);
  SurfaceScene subject = LightStageSubject();
  const Image direct = RenderUnder(subject, map, camera, 512).color;
  const double stops = AutoExposure(direct);
  const auto psnr = [&](int count) {
    OlatCapture capture;
    capture.lights = LightStageLights(count);
    const auto weights =
        RelightWeights(capture, LightVoronoi(capture.lights, map->height()), *map, 0);
    Image relit(48, 27, 3, ColorEncoding::kLinear);
    for (std::size_t i = 0; i < capture.lights.size(); ++i) {
      const Image image = RenderUnder(subject, capture.lights[i], camera);
      for (std::size_t p = 0; p < relit.pixels.size(); ++p) {
        relit.pixels[p] +=
            static_cast<float>(weights[i][static_cast<int>(p % 3)]) * image.pixels[p];
      }
    }
    const double db = Psnr(WithExposure(direct, stops), WithExposure(relit, stops));
    std::cout << "relit against direct, " << count << " lights: " << db << " dB\n";
    return db;
  };
  const double few = psnr(60);
  const double many = psnr(1000);
  EXPECT_GE(many, 40);
  EXPECT_GT(many, few + 3);
}

TEST(LightStage, UsesAMeasuredBrdfForTheThirdBall) {
  const StageCamera camera = LightStageCamera(48, 27);
  const DirectionalLight light{Vector3d(0, 0.5, 1).normalized()};
  SurfaceScene gold = LightStageSubject();
  const Conductor analytic(Color(1.00, 0.77, 0.34), 0.25);
  SurfaceScene measured =
      LightStageSubject(std::make_shared<MerlBrdf>(MerlBrdf::Tabulate(analytic)));
  SurfaceScene diffuse = LightStageSubject(std::make_shared<Lambert>(Color::Constant(0.5)));
  const Image truth = RenderUnder(gold, light, camera);
  EXPECT_GT(Psnr(RenderUnder(measured, light, camera), truth), 35);
  EXPECT_LT(Psnr(RenderUnder(diffuse, light, camera), truth), 30);
}

TEST(LightStage, ShadowsDarkenAndBouncesBrighten) {
  const StageCamera camera = LightStageCamera(32, 18);
  SurfaceScene subject = LightStageSubject();
  const DirectionalLight light{Vector3d(0.6, 0.7, 0.4).normalized()};
  const auto brightness = [&](bool shadows, int bounces) {
    TransportTerms terms{.emission = false, .shadows = shadows, .bounces = bounces};
    double sum = 0;
    for (const float value : RenderUnder(subject, light, camera, terms).pixels) sum += value;
    return sum;
  };
  EXPECT_GT(brightness(false, 0), 1.05 * brightness(true, 0));
  EXPECT_GT(brightness(true, 1), 1.01 * brightness(true, 0));
  EXPECT_GT(brightness(true, 4), brightness(true, 1));
}

TEST(LightStage, WritesACaptureThatCanBeRelit) {
  const test::ScratchFolder scratch;
  WriteImage(scratch.path() / "map.exr", [] {
    Image image(32, 16, 3, ColorEncoding::kLinear);
    std::ranges::fill(image.pixels, 0.5f);
    return image;
  }());
  LightStageOptions options;
  options.lights = 12;
  options.width = 32;
  options.height = 18;
  options.paths = 16;
  options.environment = scratch.path() / "map.exr";
  const fs::path stage = scratch.path() / "stage";
  EXPECT_TRUE(WriteLightStage(stage, options, [] { return true; }));
  EXPECT_EQ(FindOlatCapture(stage, {}).images.size(), 12u);
  EXPECT_TRUE(fs::exists(stage / "truth/direct.exr"));
  // A smaller capture in its place replaces it completely.
  options.lights = 4;
  options.environment = "";
  EXPECT_TRUE(WriteLightStage(stage, options, [] { return true; }));
  EXPECT_EQ(FindOlatCapture(stage, {}).images.size(), 4u);
  // An interrupted capture is not found.
  EXPECT_FALSE(WriteLightStage(stage, options, [] { return false; }));
  EXPECT_THAT(test::InputErrorOf([&] { FindOlatCapture(stage, {}); }), HasSubstr("stage"));
}

// Only the mark identifies a capture; files with the same names are not overwritten.
TEST(LightStage, DoesNotOverwriteForeignFiles) {
  LightStageOptions options;
  options.lights = 3;
  options.width = options.height = 4;
  const auto write = [&](const fs::path& folder) {
    return test::InputErrorOf([&] { WriteLightStage(folder, options, [] { return true; }); });
  };
  for (const char* theirs : {"lights.txt", "light_0000.exr", "truth/direct.exr", "notes.txt"}) {
    const test::ScratchFolder scratch;
    const fs::path file = scratch.Write(theirs, "theirs");
    EXPECT_THAT(write(scratch.path()), HasSubstr("choose an empty or a new folder")) << theirs;
    EXPECT_EQ(fs::file_size(file), 6u) << theirs;
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path()), {}), 1) << theirs;
  }
  const test::ScratchFolder scratch;
  scratch.Write("file", "theirs");
  EXPECT_THAT(write(scratch.path() / "file"), HasSubstr("is a file"));
}

TEST(LightStage, ReplacesAnInterruptedCapture) {
  const test::ScratchFolder scratch;
  LightStageOptions options;
  options.lights = 3;
  options.width = options.height = 4;
  int asked = 0;
  EXPECT_FALSE(WriteLightStage(scratch.path(), options, [&] { return ++asked < 3; }));
  EXPECT_TRUE(fs::exists(scratch.path() / "light_0001.exr"));
  EXPECT_TRUE(WriteLightStage(scratch.path(), options, [] { return true; }));
}

TEST(LightStage, RejectsOptionsOutOfRangeAndForeignFolders) {
  const test::ScratchFolder scratch;
  LightStageOptions options;
  options.lights = 2;
  const auto error = [&] {
    return test::InputErrorOf(
        [&] { WriteLightStage(scratch.path(), options, [] { return true; }); });
  };
  EXPECT_THAT(error(), HasSubstr("--light-stage"));
  options = {};
  options.width = 0;
  EXPECT_THAT(error(), HasSubstr("--width"));
  options = {};
  options.environment = scratch.path() / "none.hdr";
  EXPECT_THAT(error(), HasSubstr("none.hdr"));
  options = {};
  options.terms.bounces = -1;
  EXPECT_THAT(error(), HasSubstr("--bounces"));
  options = {};
  options.merl = scratch.path() / "none.binary";
  EXPECT_THAT(error(), HasSubstr("none.binary"));
  options = {};
  scratch.WriteImage("holiday.jpg", 8, 6);
  EXPECT_THAT(error(), AllOf(HasSubstr("holiday.jpg"), HasSubstr("choose an empty")));
  EXPECT_TRUE(fs::exists(scratch.path() / "holiday.jpg"));
}

}  // namespace
}  // namespace nerf::synthetic
