#include "nerf/relight/material_edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using test::InputErrorOf;
using testing::HasSubstr;

// A frame of half the size of the input, moved by 1 along x.
SceneNormalization Frame() {
  SceneNormalization frame;
  frame.scale = 0.5;
  frame.translation = {0.5, 0, 0};
  return frame;
}

class MaterialEdits : public testing::Test {
 protected:
  std::vector<MaterialEdit> Read(const std::string& text) const {
    const auto file = folder_.path() / "edits.json";
    std::ofstream(file) << text;
    return ReadMaterialEdits(file, Frame(), {{0.5f, 0, 0}, {1.5f, 0, 0}});
  }
  std::string ErrorOf(const std::string& text) const {
    return InputErrorOf([&] { Read(text); });
  }

  // Two points: 0 0 0 and 2 0 0 of the input.
  const torch::Tensor positions_ = torch::tensor({0.5f, 0.f, 0.f, 1.5f, 0.f, 0.f}).view({2, 3});
  test::ScratchFolder folder_;
};

MaterialBatch Coated() {
  return {torch::full({2, 3}, 0.5f), torch::full({2}, 0.4f), torch::zeros({2})};
}

TEST_F(MaterialEdits, ChangeWhatIsInABoxOfTheInput) {
  const auto edits = Read(R"([{"box": {"min": [-1, -1, -1], "max": [1, 1, 1]},
                              "albedo": {"scale": [2, 1, 0.5]}, "roughness": {"set": 0.8},
                              "metallic": {"set": 1}}])");
  ASSERT_EQ(edits.size(), 1u);
  MaterialBatch material = Coated();
  Apply(edits[0], positions_, material);
  EXPECT_TRUE(torch::allclose(material.base_color[0], torch::tensor({1.f, 0.5f, 0.25f})));
  EXPECT_TRUE(torch::allclose(material.base_color[1], torch::full({3}, 0.5f)));
  EXPECT_TRUE(torch::allclose(material.roughness, torch::tensor({0.8f, 0.4f})));
  EXPECT_TRUE(torch::allclose(material.metallic, torch::tensor({1.f, 0.f})));
}

TEST_F(MaterialEdits, StayInRangeAndGiveAMattSurfaceACoat) {
  const auto edits = Read(R"([{"albedo": {"scale": 9}}, {"roughness": {"scale": 0}}])");
  MaterialBatch material{torch::full({2, 3}, 0.5f), {}, {}};
  for (const MaterialEdit& edit : edits) Apply(edit, positions_, material);
  EXPECT_TRUE(torch::equal(material.base_color, torch::ones({2, 3})));
  ASSERT_FALSE(material.IsMatt());
  EXPECT_NEAR(material.roughness[0].item<double>(), kLeastRoughness, 1e-6);
  EXPECT_EQ(material.metallic.abs().sum().item<float>(), 0);
}

TEST_F(MaterialEdits, WhatIsWrongIsNamed) {
  EXPECT_THAT(ErrorOf("{}"), HasSubstr("edits.json: must be a list of edits"));
  EXPECT_THAT(ErrorOf(R"([{"colour": {}}])"), HasSubstr("[0].colour is unknown"));
  EXPECT_THAT(ErrorOf(R"([{"albedo": {"set": 2}}])"), HasSubstr("[0].albedo.set is 2"));
  EXPECT_THAT(ErrorOf(R"([{"albedo": {"set": [1, 2]}}])"), HasSubstr("must be three numbers"));
  EXPECT_THAT(ErrorOf(R"([{"roughness": {"set": -1}}])"), HasSubstr("[0].roughness.set is -1"));
  EXPECT_THAT(ErrorOf(R"([{"box": {"min": [1, 0, 0], "max": [0, 1, 1]}}])"),
              HasSubstr("min is above max"));
  EXPECT_THAT(
      ErrorOf(R"([{"box": {"min": [5, 5, 5], "max": [6, 6, 6]}}])"),
      HasSubstr("[0].box holds nothing of the surface, which is within [0, 0, 0] to [2, 0, 0]"));
}

}  // namespace
}  // namespace nerf
