#include "nerf/light/light_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using test::InputErrorOf;
using testing::HasSubstr;

class LightPlanFile : public testing::Test {
 protected:
  std::filesystem::path Write(const std::string& text) const {
    const auto file = folder_.path() / "lights.json";
    std::ofstream(file) << text;
    return file;
  }
  LightPlan Read(const std::string& text) const { return ReadLightPlan(Write(text)); }
  std::string ErrorOf(const std::string& text) const {
    const auto file = Write(text);
    return InputErrorOf([&] { ReadLightPlan(file); });
  }

  test::ScratchFolder folder_;
};

TEST_F(LightPlanFile, EnvironmentSunAndPointStandTogether) {
  const LightPlan plan = Read(R"({"lights": {
    "day": {"environment": "D65", "rotate": 90, "exposure": -1,
            "suns": [{"direction": [0, 0, 2], "irradiance": [3, 2, 1]}, {"direction": [1, 0, 0]}],
            "points": [{"position": [1, 2, 3], "watts": 12.566370614359172}]},
    "unknown": {"environment": "unknown"}},
    "photographs": {"noon/*": "day", "*": "unknown"}})");
  ASSERT_EQ(plan.lights.size(), 2u);
  const PlannedLight& day = plan.lights[0];
  EXPECT_EQ(day.name, "day");
  EXPECT_FALSE(day.has_unknown_environment);
  ASSERT_TRUE(day.environment);
  EXPECT_NEAR(Luminance(day.environment->At(0, 0)), 1, 1e-6);
  EXPECT_EQ(day.rotate, 90);
  EXPECT_EQ(day.exposure, -1);
  ASSERT_EQ(day.suns.size(), 2u);
  EXPECT_EQ(day.suns[0].to_light, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(day.suns[0].irradiance.x(), 3, 0.01);  // D65 is white
  EXPECT_NEAR(day.suns[1].irradiance.y(), std::numbers::pi, 0.01);
  ASSERT_EQ(day.points.size(), 1u);
  EXPECT_NEAR(Luminance(day.points[0].intensity), 1, 1e-6);  // 4 pi W are 1 W / sr
  EXPECT_TRUE(plan.lights[1].has_unknown_environment);
  ASSERT_EQ(plan.photographs.size(), 2u);
  EXPECT_EQ(plan.Find("unknown"), 1);
  EXPECT_EQ(plan.Find("night"), std::nullopt);
}

// A lamp of so many candela gives as much light as one of the lumens and the watts that these are.
TEST_F(LightPlanFile, CandelaLumensAndWattsAgree) {
  const auto luminance = [&](const std::string& power) {
    return Luminance(Read(R"({"lights": {"lamp": {"points": [{"position": [0, 0, 1], )" + power +
                          R"(, "color": "blackbody:3200"}]}}})")
                         .lights[0]
                         .points[0]
                         .intensity);
  };
  const double candela = luminance(R"("candela": 100)");
  EXPECT_NEAR(luminance(R"("lumens": 1256.6370614359173)") / candela, 1, 1e-9);
  // A black body of 3200 K has more light in a watt than one of D65 has: 100 cd are about 6 W.
  const double watts = 4 * std::numbers::pi * candela;
  EXPECT_GT(watts, 2);
  EXPECT_LT(watts, 10);
  EXPECT_NEAR(luminance(R"("watts": )" + std::to_string(watts)) / candela, 1, 1e-5);
}

TEST_F(LightPlanFile, WhatIsWrongIsNamed) {
  EXPECT_THAT(ErrorOf("{}"), HasSubstr("lights.json: lights is missing"));
  EXPECT_THAT(ErrorOf(R"({"lights": {"a": {}}})"), HasSubstr("lights.a: there is no light"));
  EXPECT_THAT(ErrorOf(R"({"lights": {"a": {"envronment": "D65"}}})"),
              HasSubstr("lights.a.envronment is unknown"));
  EXPECT_THAT(ErrorOf(R"({"lights": {"a": {"suns": [{"irradiance": 1}]}}})"),
              HasSubstr("lights.a.suns[0].direction is missing"));
  EXPECT_THAT(ErrorOf(R"({"lights": {"a": {"suns": [{"direction": [0, 0, 0]}]}}})"),
              HasSubstr("lights.a.suns[0].direction is missing"));
  EXPECT_THAT(
      ErrorOf(R"({"lights": {"a": {"suns": [{"direction": [0, 0, 1], "irradiance": -1}]}}})"),
      HasSubstr("irradiance must be 0 to"));
  EXPECT_THAT(ErrorOf(R"({"lights": {"a": {"points": [{"position": [0, 0, 1]}]}}})"),
              HasSubstr("give watts, candela or lumens"));
  EXPECT_THAT(
      ErrorOf(
          R"({"lights": {"a": {"points": [{"position": [0, 0, 1], "watts": 1, "lumens": 2}]}}})"),
      HasSubstr("give one of watts, candela and lumens"));
  EXPECT_THAT(
      ErrorOf(R"({"lights": {"a": {"suns": [{"direction": [0, 0, 1], "color": "pink"}]}}})"),
      HasSubstr("there is no light pink"));
  EXPECT_THAT(ErrorOf(R"({"lights": {"a": {"environment": "nowhere.hdr"}}})"),
              HasSubstr("nowhere.hdr"));
  EXPECT_THAT(ErrorOf(R"({"lights": {"a": {"environment": "D65"}}, "photographs": {"*": "b"}})"),
              HasSubstr("there is no light 'b'"));
}

TEST_F(LightPlanFile, ACopyInAnotherFolderNamesTheSameFiles) {
  const auto file =
      Write(R"({"lights": {"a": {"environment": "D65"}, "b": {"environment": "unknown"}}})");
  std::filesystem::create_directory(folder_.path() / "run");
  CopyLightPlan(file, folder_.path() / "run" / "lights.json");
  const LightPlan copy = ReadLightPlan(folder_.path() / "run" / "lights.json");
  EXPECT_TRUE(copy.lights[0].environment);
  EXPECT_TRUE(copy.lights[1].has_unknown_environment);
}

}  // namespace
}  // namespace nerf
