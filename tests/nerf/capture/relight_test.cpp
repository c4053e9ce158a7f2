#include "nerf/capture/relight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>

#include "nerf/image/image_io.h"
#include "nerf/image/image_metrics.h"
#include "nerf/light/light_file.h"
#include "nerf/material/lambert.h"
#include "nerf/material/merl.h"
#include "nerf/material/microfacet.h"
#include "nerf/synthetic/light_stage.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::appearance {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

// Soft light from above, a wide warm glow at one side, a cool one at the other.
EnvironmentMap SmoothEnvironment() {
  Image image(256, 128, 3, ColorEncoding::kLinear);
  const EnvironmentMap grid(image, "grid");
  const Vector3d warm = Vector3d(-0.8, 0.5, 0.6).normalized();
  const Vector3d cool = Vector3d(0.9, 0.3, 0.2).normalized();
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 256; ++x) {
      const Vector3d d = grid.Direction(x, y);
      const Color radiance = Color(0.25, 0.3, 0.35) * (1 + d.y()) +
                             Color(2.0, 1.4, 0.8) * std::exp(6 * (d.dot(warm) - 1)) +
                             Color(0.5, 0.8, 1.4) * std::exp(4 * (d.dot(cool) - 1));
      for (int c = 0; c < 3; ++c) image.At(x, y)[c] = static_cast<float>(radiance[c]);
    }
  }
  return {image, "smooth"};
}

// A capture of flat images: image i has the value i + 1 in red, half of that in green.
OlatCapture FlatCapture(const fs::path& folder, const std::vector<DirectionalLight>& lights) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Image image(4, 3, 3, ColorEncoding::kLinear);
    for (std::size_t p = 0; p < image.pixels.size(); p += 3) {
      image.pixels[p] = static_cast<float>(i + 1);
      image.pixels[p + 1] = static_cast<float>(i + 1) / 2;
    }
    WriteImage(folder / fmt::format("{}.exr", i), image);
  }
  WriteLights(folder / "lights.txt", lights);
  return FindOlatCapture(folder, {});
}

Image RelitOnce(const OlatCapture& capture, const std::vector<Color>& weights) {
  Image result;
  Relight(
      capture, InputEncoding::kAuto, {weights}, 1 << 20, [] { return true; },
      [&](int, const Image& picture) { result = picture; });
  return result;
}

TEST(Relight, SumsImagesByTheirWeightsChannelByChannel) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), LightStageLights(3));
  const Image relit = RelitOnce(capture, {Color(1, 0, 0), Color(0.5, 2, 0), Color(0, 0, 9)});
  EXPECT_NEAR(relit.At(1, 1)[0], 1 * 1 + 2 * 0.5, 1e-6);
  EXPECT_NEAR(relit.At(1, 1)[1], 1 * 2, 1e-6);
  EXPECT_EQ(relit.At(1, 1)[2], 0);
}

// A matt white plate that faces up, under each light: pi / E times the image is its reflectance.
TEST(Relight, WeighsByTheLightsIrradiance) {
  const test::ScratchFolder scratch;
  std::vector<DirectionalLight> lights = LightStageLights(200);
  for (std::size_t i = 0; i < lights.size(); ++i) lights[i].irradiance *= i % 2 == 0 ? 1 : 3;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Image image(2, 2, 3, ColorEncoding::kLinear);
    const double value =
        std::max(0.0, lights[i].to_light.y()) * lights[i].irradiance.x() / std::numbers::pi;
    std::ranges::fill(image.pixels, static_cast<float>(value));
    WriteImage(scratch.path() / fmt::format("{}.exr", i), image);
  }
  WriteLights(scratch.path() / "lights.txt", lights);
  const OlatCapture capture = FindOlatCapture(scratch.path(), {});
  const EnvironmentMap map = SmoothEnvironment();
  const LightVoronoi cells(capture.lights, map.height());
  const Image relit = RelitOnce(capture, RelightWeights(capture, cells, map, 0));
  const Color expected = map.Irradiance(Vector3d::UnitY()) / std::numbers::pi;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(relit.At(0, 0)[c], expected[c], 0.01 * expected[c]);
}

TEST(Relight, InLittleMemoryIsTheSameInMorePasses) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), LightStageLights(5));
  std::vector<std::vector<Color>> weights;
  for (int set = 0; set < 7; ++set) {
    weights.emplace_back(5, Color::Constant(0.1 * set + 0.05));
  }
  const auto relight = [&](std::int64_t memory) {
    std::vector<float> values;
    EXPECT_TRUE(Relight(
        capture, InputEncoding::kAuto, weights, memory, [] { return true; },
        [&](int set, const Image& picture) {
          EXPECT_EQ(set, static_cast<int>(values.size()));
          values.push_back(picture.pixels[0]);
        }));
    return values;
  };
  const auto at_once = relight(1 << 20);
  EXPECT_EQ(at_once.size(), 7u);
  EXPECT_EQ(relight(1), at_once);
  EXPECT_EQ(relight(4 * 4 * 3 * 3 * 4), at_once);
}

TEST(Relight, StopsWhenItIsAsked) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), LightStageLights(5));
  int asked = 0;
  EXPECT_FALSE(Relight(
      capture, InputEncoding::kAuto, {std::vector<Color>(5, Color::Ones())}, 1 << 20,
      [&] { return ++asked < 3; }, [](int, const Image&) { ADD_FAILURE() << "half a picture"; }));
}

TEST(Relight, NamesAnImageThatCannotBeRead) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), LightStageLights(5));
  scratch.Write("3.exr", "no picture");
  EXPECT_THAT(test::InputErrorOf([&] { RelitOnce(capture, std::vector<Color>(5, Color::Ones())); }),
              HasSubstr("3.exr"));
}

TEST(Relight, RefusesACaptureInTheDark) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), LightStageLights(4));
  RefuseBlackCapture(capture, InputEncoding::kAuto);
  for (const fs::path& file : capture.images) {
    WriteImage(file, Image(4, 3, 3, ColorEncoding::kLinear));
  }
  EXPECT_THAT(test::InputErrorOf([&] { RefuseBlackCapture(capture, InputEncoding::kAuto); }),
              AllOf(HasSubstr(scratch.path().string()), HasSubstr("all 4 images are black")));
}

TEST(Exposure, IsInStopsAndByItselfPutsBrightPartsBelowWhite) {
  Image image(10, 10, 3, ColorEncoding::kLinear);
  std::ranges::fill(image.pixels, 3.2f);
  EXPECT_NEAR(AutoExposure(image), -2, 1e-6);
  EXPECT_NEAR(Exposed(image, 1).pixels[0], 6.4, 1e-6);
  std::ranges::fill(image.pixels, 0.0f);
  EXPECT_EQ(AutoExposure(image), 0);
}

// The whole claim: one light at a time, summed, is the subject under the environment.
TEST(LightStage, RelitIsWhatIsSeenDirectlyUnderTheEnvironment) {
  const auto map = std::make_shared<EnvironmentMap>(SmoothEnvironment());
  const StageCamera camera = LightStageCamera(48, 27);
  SurfaceScene subject = LightStageSubject();
  const Image direct = PhotographUnder(subject, map, camera, 512).color;
  const double stops = AutoExposure(direct);
  const auto psnr = [&](int count) {
    OlatCapture capture;
    capture.lights = LightStageLights(count);
    const auto weights =
        RelightWeights(capture, LightVoronoi(capture.lights, map->height()), *map, 0);
    Image relit(48, 27, 3, ColorEncoding::kLinear);
    for (std::size_t i = 0; i < capture.lights.size(); ++i) {
      const Image image = PhotographUnder(subject, capture.lights[i], camera);
      for (std::size_t p = 0; p < relit.pixels.size(); ++p) {
        relit.pixels[p] +=
            static_cast<float>(weights[i][static_cast<int>(p % 3)]) * image.pixels[p];
      }
    }
    const double db = Psnr(Exposed(direct, stops), Exposed(relit, stops));
    std::cout << "relit against direct, " << count << " lights: " << db << " dB\n";
    return db;
  };
  const double few = psnr(60);
  const double many = psnr(1000);
  EXPECT_GE(many, 40);
  EXPECT_GT(many, few + 3);
}

TEST(LightStage, DressesTheThirdBallInAMeasuredBrdf) {
  const StageCamera camera = LightStageCamera(48, 27);
  const DirectionalLight light{Vector3d(0, 0.5, 1).normalized()};
  SurfaceScene gold = LightStageSubject();
  const Conductor analytic(Color(1.00, 0.77, 0.34), 0.25);
  SurfaceScene measured =
      LightStageSubject(std::make_shared<MerlBrdf>(MerlBrdf::Measure(analytic)));
  SurfaceScene matt = LightStageSubject(std::make_shared<Lambert>(Color::Constant(0.5)));
  const Image truth = PhotographUnder(gold, light, camera);
  EXPECT_GT(Psnr(PhotographUnder(measured, light, camera), truth), 35);
  EXPECT_LT(Psnr(PhotographUnder(matt, light, camera), truth), 30);
}

// Each term adds light, or takes it away: no light passes unseen from one to the next.
TEST(LightStage, ShadowsTakeLightAndBouncesGiveSomeBack) {
  const StageCamera camera = LightStageCamera(32, 18);
  SurfaceScene subject = LightStageSubject();
  const DirectionalLight light{Vector3d(0.6, 0.7, 0.4).normalized()};
  const auto brightness = [&](bool shadows, int bounces) {
    TransportTerms terms{.emission = false, .shadows = shadows, .bounces = bounces};
    double sum = 0;
    for (const float value : PhotographUnder(subject, light, camera, terms).pixels) sum += value;
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
  // A smaller one in its place leaves nothing of it.
  options.lights = 4;
  options.environment = "";
  EXPECT_TRUE(WriteLightStage(stage, options, [] { return true; }));
  EXPECT_EQ(FindOlatCapture(stage, {}).images.size(), 4u);
  // Stopped half-way it is none.
  EXPECT_FALSE(WriteLightStage(stage, options, [] { return false; }));
  EXPECT_THAT(test::InputErrorOf([&] { FindOlatCapture(stage, {}); }), HasSubstr("stage"));
}

// Names alone do not make a file ours: only the mark of a capture of ours does.
TEST(LightStage, LeavesFilesOfOthersAlone) {
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

TEST(LightStage, ThatWasStoppedIsReplaced) {
  const test::ScratchFolder scratch;
  LightStageOptions options;
  options.lights = 3;
  options.width = options.height = 4;
  int asked = 0;
  EXPECT_FALSE(WriteLightStage(scratch.path(), options, [&] { return ++asked < 3; }));
  EXPECT_TRUE(fs::exists(scratch.path() / "light_0001.exr"));
  EXPECT_TRUE(WriteLightStage(scratch.path(), options, [] { return true; }));
}

TEST(LightStage, RefusesOptionsOutOfRangeAndFoldersOfOthers) {
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
}  // namespace nerf::appearance
