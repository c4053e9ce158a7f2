#include "nerf/pipeline/photograph_lights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

using testing::HasSubstr;

PosedImage LitPhotograph(const std::string& name, const NamedLight& light = {}) {
  PosedImage image;
  image.name = name;
  image.split = Split::kTrain;
  image.light = light;
  return image;
}

PosedImages CaptureOf(std::vector<PosedImage> images) {
  PosedImages posed;
  posed.images = std::move(images);
  return posed;
}

NamedLight DistantFrom(const Eigen::Vector3d& direction) {
  NamedLight light;
  light.direction = direction;
  return light;
}

// World z is up, and the frame is turned by a quarter about it.
SceneNormalization TurnedFrame() {
  SceneNormalization frame;
  frame.scale = 0.5;
  frame.rotation =
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return frame;
}

TEST(PhotographLights, WithoutAWordThereIsOneUnknownLight) {
  const PhotographLights lights = LightsOn(CaptureOf({LitPhotograph("a"), LitPhotograph("b")}),
                                           std::nullopt, TurnedFrame(), 32);
  ASSERT_EQ(lights.groups.size(), 1u);
  EXPECT_FALSE(lights.groups[0].IsKnown());
  EXPECT_EQ(lights.group_of.at("a"), 0);
  EXPECT_EQ(lights.group_of.at("b"), 0);
}

TEST(PhotographLights, NamesMakeGroupsAndDirectionsDarkRooms) {
  NamedLight noon;
  noon.name = "noon";
  const PhotographLights named =
      LightsOn(CaptureOf({LitPhotograph("a"), LitPhotograph("b", noon), LitPhotograph("c", noon)}),
               std::nullopt, TurnedFrame(), 32);
  ASSERT_EQ(named.groups.size(), 2u);
  EXPECT_EQ(named.groups[1].name, "noon");
  EXPECT_EQ(named.group_of.at("c"), 1);

  const PhotographLights single =
      LightsOn(CaptureOf({LitPhotograph("a", DistantFrom(Eigen::Vector3d::UnitX())),
                          LitPhotograph("b", DistantFrom(Eigen::Vector3d::UnitZ())),
                          LitPhotograph("c", DistantFrom(Eigen::Vector3d::UnitX()))}),
               std::nullopt, TurnedFrame(), 32);
  ASSERT_EQ(single.groups.size(), 2u);
  EXPECT_EQ(single.group_of.at("c"), 0);
  EXPECT_TRUE(single.groups[0].IsKnown());
  EXPECT_EQ(single.groups[0].environment.abs().sum().item<float>(), 0);
  // In the frame, x of the world is y.
  const auto& sun = std::get<DirectionalLight>(single.groups[0].lamps.at(0));
  EXPECT_LT((sun.to_light - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(PhotographLights, APlanSaysWhichLightIsWhere) {
  LightPlan plan;
  PlannedLight day, lamp;
  day.name = "day";
  day.environment = EnvironmentMap::Uniform({1, 2, 3});
  day.exposure = 1;
  lamp.name = "lamp";
  lamp.points = {PointLight{{2, 0, 0}, {1, 1, 1}}};
  plan.lights = {day, lamp};
  plan.photographs = {{"out/*", 0}, {"in/*", 1}};
  const PhotographLights lights =
      LightsOn(CaptureOf({LitPhotograph("in/1"), LitPhotograph("out/1")}), plan, TurnedFrame(), 32);
  ASSERT_EQ(lights.groups.size(), 2u);
  const LightGroup& indoors = lights.groups[lights.group_of.at("in/1")];
  const LightGroup& outdoors = lights.groups[lights.group_of.at("out/1")];
  EXPECT_NEAR(outdoors.environment[5][1].item<double>(), 4, 1e-5);  // a stop brighter
  // A lamp lights a surface as bright in the frame as in the world, at half the distance.
  const auto& point = std::get<PointLight>(indoors.lamps.at(0));
  EXPECT_LT((point.x_in_world - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(point.intensity.x(), 0.25, 1e-12);
}

TEST(PhotographLights, WhatIsNotClearIsNamed) {
  const auto error = [](PosedImages posed, const std::optional<LightPlan>& plan) {
    return test::InputErrorOf([&] { LightsOn(posed, plan, TurnedFrame(), 16); });
  };
  EXPECT_THAT(error(CaptureOf({LitPhotograph("a", DistantFrom(Eigen::Vector3d::UnitX())),
                               LitPhotograph("b")}),
                    std::nullopt),
              HasSubstr("the photograph b has no light_direction"));
  LightPlan plan;
  plan.lights.resize(2);
  plan.lights[0].name = "x";
  plan.lights[1].name = "y";
  EXPECT_THAT(error(CaptureOf({LitPhotograph("a")}), plan), HasSubstr("the photograph a has none"));
  plan.photographs = {{"a*", 0}, {"*", 1}};
  EXPECT_THAT(error(CaptureOf({LitPhotograph("a")}), plan),
              HasSubstr("the photograph a fits patterns of the lights x and y"));
}

}  // namespace
}  // namespace nerf
