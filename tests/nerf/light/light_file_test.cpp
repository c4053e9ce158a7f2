#include "nerf/light/light_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nerf/base/atomic_file.h"
#include "nerf/geometry/directions.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(LightFile, ReadsDirectionsOfAnyLengthWithOptionalIntensities) {
  const test::ScratchFolder scratch;
  const auto lights =
      ReadLights(scratch.Write("lights.txt", "3\n0 0 2\n\n3 0 4 2 # bright\n0 1 0 1 2 3\n")).lights;
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_TRUE(lights[0].to_light.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(lights[0].irradiance.x(), std::numbers::pi, 1e-12);
  EXPECT_TRUE(lights[1].to_light.isApprox(Eigen::Vector3d(0.6, 0, 0.8)));
  EXPECT_NEAR(lights[1].irradiance.z(), 2 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(lights[2].irradiance.y(), 2 * std::numbers::pi, 1e-12);
}

TEST(LightFile, IsReadBackUnchanged) {
  const test::ScratchFolder scratch;
  std::vector<DirectionalLight> lights = {
      {Eigen::Vector3d(1, 2, -3).normalized()},
      {Eigen::Vector3d(-1, 0.1, 0.7).normalized(), Color(0.1, 2, 30)}};
  for (int i = 0; i < 200; ++i) {
    const double scale = std::exp2(i % 40 - 20);
    lights.push_back({FibonacciDirection(i, 200), scale * Color(1 + i, 0.3, 1.0 / (1 + i))});
  }
  WriteLights(scratch.path() / "lights.txt", lights);
  const auto back = ReadLights(scratch.path() / "lights.txt").lights;
  ASSERT_EQ(back.size(), lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    EXPECT_LT((back[i].to_light - lights[i].to_light).norm(), 1e-8) << i;
    EXPECT_LT((back[i].irradiance / lights[i].irradiance - 1).abs().maxCoeff(), 1e-8) << i;
  }
  // What was read is written the same.
  WriteLights(scratch.path() / "again.txt", back);
  EXPECT_EQ(ReadWholeFile(scratch.path() / "again.txt"),
            ReadWholeFile(scratch.path() / "lights.txt"));
}

TEST(LightFile, OmitsIntensitiesOfOneAndNamesAFileThatCannotBeWritten) {
  const test::ScratchFolder scratch;
  const std::vector<DirectionalLight> lights = {{Eigen::Vector3d::UnitX()}};
  WriteLights(scratch.path() / "lights.txt", lights);
  EXPECT_THAT(ReadWholeFile(scratch.path() / "lights.txt"),
              testing::EndsWith("\n1.000000000 0.000000000 0.000000000\n"));
  EXPECT_THAT(test::InputErrorOf([&] { WriteLights("/nowhere/lights.txt", lights); }),
              HasSubstr("/nowhere/lights.txt"));
}

TEST(LightFile, ErrorsNameTheFileAndTheLine) {
  const test::ScratchFolder scratch;
  const auto error = [&](const char* text) {
    const auto file = scratch.Write("lights.txt", text);
    const std::string message = test::InputErrorOf([&] { ReadLights(file); });
    EXPECT_THAT(message, HasSubstr(file.string()));
    return message;
  };
  EXPECT_THAT(error("0 0 1\n0 1\n"), AllOf(HasSubstr(":2"), HasSubstr("x y z")));
  EXPECT_THAT(error("0 0 1\nleft 0 1\n"), HasSubstr(":2"));
  EXPECT_THAT(error("0 0 nan\n"), HasSubstr(":1"));
  EXPECT_THAT(error("0 0 0\n"), HasSubstr("direction"));
  EXPECT_THAT(error("0 0 1 -1\n"), HasSubstr("above 0"));
  EXPECT_THAT(error("3\n0 0 1\n1 0 1\n"), AllOf(HasSubstr("announces 3"), HasSubstr("2 follow")));
  EXPECT_THAT(error("# none\n"), HasSubstr("no lights"));
}

TEST(LightFile, MayNameItsImages) {
  const test::ScratchFolder scratch;
  const LightList list = ReadLights(scratch.Write(
      "coin.lp",
      "3\r\ncoin 01.jpg 0 0 1\r\n\"C:\\my scans\\coin_2.JPG\" 1 0 0\r\n/a/3.png\t0 1 0 2\r\n"));
  EXPECT_EQ(list.images, (std::vector<std::string>{"coin 01.jpg", "coin_2.JPG", "3.png"}));
  EXPECT_TRUE(list.lights[1].to_light.isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(list.has_intensities);
  EXPECT_EQ(ReadLights(scratch.Write("stem.lp", "img_1 0 0 1\nimg_2 1 0 0\n")).images,
            (std::vector<std::string>{"img_1", "img_2"}));
  // Names in comments are none.
  const LightList commented = ReadLights(scratch.Write(
      "commented.txt", "\xef\xbb\xbf# order as c0.png first\n0 0 1 # c0.png\n1 0 0 # c1.png\n"));
  EXPECT_TRUE(commented.images.empty());
  EXPECT_EQ(commented.lights.size(), 2u);
  EXPECT_EQ(ReadLights(scratch.Write("named.txt", "a.jpg 0 0 1 # b.jpg\n")).images,
            std::vector<std::string>{"a.jpg"});
  const auto error = [&](const char* text) {
    return test::InputErrorOf([&] { ReadLights(scratch.Write("coin.lp", text)); });
  };
  EXPECT_THAT(error("a.jpg 0 0 1\n0 1 0\n"),
              AllOf(HasSubstr("coin.lp:2"), HasSubstr("every line")));
  EXPECT_THAT(error("a.jpg 0,5 0,1 0,9\n"), AllOf(HasSubstr("coin.lp:1"), HasSubstr("points")));
}

TEST(LightFile, OfDirectionsHasTheIntensitiesBesideIt) {
  const test::ScratchFolder scratch;
  const auto directions = scratch.Write("light_directions.txt", "0 0 1\n1 0 0\n");
  EXPECT_FALSE(ReadLights(directions).has_intensities);
  scratch.Write("light_intensities.txt", "1 2 3\n4\n");
  const LightList list = ReadLights(directions);
  EXPECT_TRUE(list.has_intensities);
  EXPECT_TRUE(list.lights[0].irradiance.isApprox(std::numbers::pi * Color(1, 2, 3)));
  EXPECT_TRUE(list.lights[1].irradiance.isApprox(std::numbers::pi * Color(4, 4, 4)));
  scratch.Write("light_intensities.txt", "1 2 3\n");
  EXPECT_THAT(test::InputErrorOf([&] { ReadLights(directions); }),
              HasSubstr("1 intensities for 2 lights"));
  scratch.Write("light_intensities.txt", "1 2 3\n0 1 1\n");
  EXPECT_THAT(test::InputErrorOf([&] { ReadLights(directions); }),
              HasSubstr("light_intensities.txt:2"));
}

}  // namespace
}  // namespace nerf
