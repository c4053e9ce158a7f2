#include "nerf/capture/relight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "nerf/image/image_io.h"
#include "nerf/light/light_file.h"
#include "nerf/synthetic/light_stage.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/smooth_environment.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

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

TEST(Relight, SumsWeightedImagesChannelByChannel) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), synthetic::LightStageLights(3));
  const Image relit = RelitOnce(capture, {Color(1, 0, 0), Color(0.5, 2, 0), Color(0, 0, 9)});
  EXPECT_NEAR(relit.At(1, 1)[0], 1 * 1 + 2 * 0.5, 1e-6);
  EXPECT_NEAR(relit.At(1, 1)[1], 1 * 2, 1e-6);
  EXPECT_EQ(relit.At(1, 1)[2], 0);
}

// A white diffuse plate that faces up, under lights of different irradiance.
TEST(Relight, DividesByTheIrradianceOfTheLights) {
  const test::ScratchFolder scratch;
  std::vector<DirectionalLight> lights = synthetic::LightStageLights(200);
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
  const EnvironmentMap map = test::SmoothEnvironment();
  const LightVoronoi cells(capture.lights, map.height());
  const Image relit = RelitOnce(capture, RelightWeights(capture, cells, map, 0));
  const Color expected = map.Irradiance(Vector3d::UnitY()) / std::numbers::pi;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(relit.At(0, 0)[c], expected[c], 0.01 * expected[c]);
}

TEST(Relight, IsTheSameInLittleMemory) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), synthetic::LightStageLights(5));
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

TEST(Relight, CanBeStopped) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), synthetic::LightStageLights(5));
  int asked = 0;
  EXPECT_FALSE(Relight(
      capture, InputEncoding::kAuto, {std::vector<Color>(5, Color::Ones())}, 1 << 20,
      [&] { return ++asked < 3; },
      [](int, const Image&) { ADD_FAILURE() << "an incomplete picture"; }));
}

TEST(Relight, NamesAnImageThatCannotBeRead) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), synthetic::LightStageLights(5));
  scratch.Write("3.exr", "no picture");
  EXPECT_THAT(test::InputErrorOf([&] { RelitOnce(capture, std::vector<Color>(5, Color::Ones())); }),
              HasSubstr("3.exr"));
}

TEST(Relight, RejectsABlackCapture) {
  const test::ScratchFolder scratch;
  const OlatCapture capture = FlatCapture(scratch.path(), synthetic::LightStageLights(4));
  CheckNotBlack(capture, InputEncoding::kAuto);
  for (const fs::path& file : capture.images) {
    WriteImage(file, Image(4, 3, 3, ColorEncoding::kLinear));
  }
  EXPECT_THAT(test::InputErrorOf([&] { CheckNotBlack(capture, InputEncoding::kAuto); }),
              AllOf(HasSubstr(scratch.path().string()), HasSubstr("all 4 images are black")));
}

TEST(Exposure, IsInStopsAndAutomaticallyBelowWhite) {
  Image image(10, 10, 3, ColorEncoding::kLinear);
  std::ranges::fill(image.pixels, 3.2f);
  EXPECT_NEAR(AutoExposure(image), -2, 1e-6);
  EXPECT_NEAR(WithExposure(image, 1).pixels[0], 6.4, 1e-6);
  std::ranges::fill(image.pixels, 0.0f);
  EXPECT_EQ(AutoExposure(image), 0);
}

}  // namespace
}  // namespace nerf
