#include "nerf/pipeline/held_out_halves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "nerf/field/pose_refinement.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/pixel_sampler.h"
#include "nerf/train/trainer.h"
#include "nerf/train/validation.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_capture.h"

namespace nerf {
namespace {

using testing::ElementsAre;

// Red is the column of a pixel, green its row; every third pixel is not held.
View Photograph(const std::string& name) {
  View view;
  view.name = name;
  view.camera = PinholeFromFov(8, 6, 1);
  view.normalized_from_camera = Eigen::Isometry3d::Identity();
  for (int pixel = 0; pixel < 48; ++pixel) {
    if (pixel % 3 == 0) continue;
    view.valid_pixels.push_back(pixel);
    for (const int channel : {pixel % 8, pixel / 8, 0, 1}) {
      view.rgba.emplace_back(static_cast<float>(channel));
    }
  }
  view.depth_observations = {{3, 1.5f}, {4, 2.5f}};
  return view;
}

Dataset Photographs(int train, int validation) {
  Dataset data;
  for (int i = 0; i < train + validation; ++i) {
    (i < train ? data.train : data.validation).push_back(Photograph(std::to_string(i)));
  }
  return data;
}

std::vector<std::string> NamesOf(const std::vector<View>& views) {
  std::vector<std::string> names;
  for (const View& view : views) names.push_back(view.name);
  return names;
}

TEST(ColumnsOf, KeepsThePixelsAndPointsOfThePart) {
  const View whole = Photograph("a");
  const View right = ColumnsOf(whole, 4, 8);
  EXPECT_EQ(right.StoredCount() + ColumnsOf(whole, 0, 4).StoredCount(), whole.StoredCount());
  for (std::int64_t k = 0; k < right.StoredCount(); ++k) {
    const std::int64_t pixel = right.PixelIndex(k);
    EXPECT_EQ(static_cast<float>(right.rgba[4 * k]), static_cast<float>(4 + pixel % 4));
    EXPECT_EQ(static_cast<float>(right.rgba[4 * k + 1]), static_cast<float>(pixel / 4));
    EXPECT_EQ(right.StoredNear(pixel), k);
  }
  ASSERT_EQ(right.depth_observations.size(), 1u);
  EXPECT_EQ(right.depth_observations[0].pixel, 0);
  EXPECT_EQ(right.depth_observations[0].distance, 2.5f);
}

TEST(HeldOutHalves, AreForValidationAndAreRestoredAfterwards) {
  Dataset data = Photographs(40, 1);
  const std::vector<std::string> before = NamesOf(data.train);
  {
    const HeldOutHalves held_out(data);
    EXPECT_EQ(held_out.Count(), 8u);
    EXPECT_EQ(data.validation.size(), 8u);
    EXPECT_EQ(NamesOf(data.train), before);
    int halves = 0;
    for (const View& view : data.train) halves += view.camera.width == 4;
    EXPECT_EQ(halves, 8);
    for (const View& right : data.validation) {
      const View& left = data.train[std::stoul(right.name)];
      EXPECT_EQ(left.camera.width, 4) << right.name;
      EXPECT_EQ(left.StoredCount() + right.StoredCount(), Photograph("").StoredCount());
    }
  }
  EXPECT_EQ(NamesOf(data.train), before);
  EXPECT_EQ(NamesOf(data.validation), std::vector<std::string>{"40"});
  for (const View& view : data.train) EXPECT_EQ(view.StoredCount(), Photograph("").StoredCount());
}

TEST(HeldOutHalves, AreOfAtMostAQuarterOfThePhotographs) {
  for (const auto& [train, count] : {std::pair(12, 3u), std::pair(7, 1u), std::pair(3, 0u)}) {
    Dataset data = Photographs(train, 0);
    EXPECT_EQ(HeldOutHalves(data).Count(), count) << train;
  }
}

TEST(HeldOutHalves, SkipPhotographsWithAMaskedHalf) {
  Dataset data = Photographs(8, 0);
  data.train[2] = ColumnsOf(data.train[2], 0, 4);
  data.train[2].camera = Photograph("").camera;
  for (std::uint32_t& pixel : data.train[2].valid_pixels) pixel = pixel / 4 * 8 + pixel % 4;
  const HeldOutHalves held_out(data);
  EXPECT_THAT(NamesOf(data.validation), ElementsAre("6"));
}

// The other half of a photograph that was trained on is rendered from its refined pose.
TEST(HeldOutHalves, AreRenderedFromRefinedPoses) {
  test::SmallCapture capture = test::MakeSmallCapture(9, 24, 18);
  const HeldOutHalves held_out(capture.data);
  Config config = test::SmallConfig();
  config.effects.pose_refinement.emplace();
  const test::ScratchFolder run;
  Trainer trainer(config, capture.scene, capture.data, run.path());
  trainer.TakeSteps(50);
  const Model& model = trainer.GetModel();
  {
    const torch::NoGradGuard no_grad;
    torch::manual_seed(1);
    model.pose_refinement->named_parameters()["twist"].normal_();
  }
  std::vector<View> halves = capture.data.validation;
  ASSERT_FALSE(halves.empty());
  const double refined = Validation(halves, 1).Psnr(model, false);
  std::vector<View> as_given = halves;
  for (View& half : as_given) half.name = "unknown " + half.name;
  EXPECT_GT(std::fabs(Validation(as_given, 1).Psnr(model, false) - refined), 0.1);
  for (View& half : halves) {
    std::size_t index = 0;
    while (capture.data.train[index].name != half.name) ++index;
    half.normalized_from_camera = model.pose_refinement->Refined(static_cast<std::int64_t>(index),
                                                                 half.normalized_from_camera);
    half.name = "unknown " + half.name;
  }
  EXPECT_NEAR(Validation(halves, 1).Psnr(model, false), refined, 2e-3);
}

}  // namespace
}  // namespace nerf
