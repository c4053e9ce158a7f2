#include "nerf/field/exposure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/effects/exposure_fit.h"
#include "nerf/field/tensor_span.h"
#include "tests/support/analytic_capture.h"
#include "tests/support/central_differences.h"
#include "tests/support/input_error_of.h"
#include "tests/support/tiny_training.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

std::shared_ptr<Exposure> SomeExposure(ColorEncoding encoding) {
  auto exposure = std::make_shared<Exposure>(3, encoding);
  const torch::NoGradGuard no_grad;
  torch::manual_seed(2);
  exposure->parameters()[0].uniform_(-0.9, 0.9);
  return exposure;
}

torch::Tensor Photographs(std::vector<std::int64_t> index) { return torch::tensor(index); }

TEST(Exposure, WithGainOneChangesNoBit) {
  Exposure exposure(3, ColorEncoding::kSrgb);
  torch::manual_seed(1);
  const torch::Tensor rgb = torch::rand({5, 3}), target = torch::rand({5, 3});
  EXPECT_TRUE(exposure.forward(rgb, Photographs({0, 1, 2, 1, 0}), target).equal(rgb));
}

TEST(Exposure, IgnoresTheMeanOfTheLogGains) {
  const auto exposure = SomeExposure(ColorEncoding::kLinear);
  const torch::NoGradGuard no_grad;
  const torch::Tensor before = exposure->Gains().clone();
  EXPECT_NEAR(before.log().mean().item<double>(), 0, 1e-6);
  exposure->parameters()[0].add_(0.7);
  EXPECT_LT((exposure->Gains() - before).abs().max().item<double>(), 1e-6);
}

TEST(Exposure, AllowsBrighterColoursAtClippedPixels) {
  const auto exposure = SomeExposure(ColorEncoding::kSrgb);
  const torch::Tensor white = torch::ones({1, 3}), bright = torch::full({1, 3}, 9.0);
  EXPECT_TRUE(exposure->forward(bright, Photographs({0}), white).equal(white));
  // Not for linear radiance, which is never clipped.
  const auto linear = SomeExposure(ColorEncoding::kLinear);
  EXPECT_GT((linear->forward(bright, Photographs({0}), white) - white).abs().min().item<double>(),
            1);
}

TEST(Exposure, IsInitializedFromStops) {
  const std::vector<double> stops = {3, 1, 2};
  Exposure linear(3, ColorEncoding::kLinear);
  linear.Initialize(stops);
  const torch::NoGradGuard no_grad;
  EXPECT_NEAR(linear.Gains()[0][0].item<double>(), 2, 1e-6);
  EXPECT_NEAR(linear.Gains()[1][1].item<double>(), 0.5, 1e-6);
  EXPECT_NEAR(linear.Gains()[2][2].item<double>(), 1, 1e-6);
  Exposure encoded(3, ColorEncoding::kSrgb);
  encoded.Initialize(stops);
  EXPECT_NEAR(encoded.Gains()[0][0].item<double>(), std::pow(2.0, 1 / 2.2), 1e-6);
}

TEST(Exposure, GradientsMatchCentralDifferences) {
  const auto exposure = SomeExposure(ColorEncoding::kLinear);
  exposure->to(torch::kDouble);
  const torch::Tensor rgb = torch::rand({6, 3}, torch::dtype(torch::kDouble)).requires_grad_(true);
  const torch::Tensor target = torch::rand({6, 3}, torch::kDouble);
  const auto loss = [&] {
    return (exposure->forward(rgb, Photographs({0, 1, 2, 2, 1, 2}), target) - target)
        .square()
        .sum();
  };
  test::ExpectGradientMatchesCentralDifferences(loss, exposure->parameters()[0], 1e-6, 1e-8);
  test::ExpectGradientMatchesCentralDifferences(loss, rgb, 1e-6, 1e-8);
}

TEST(Exposure, IsTheSameInBothEngines) {
  for (const auto encoding : {ColorEncoding::kSrgb, ColorEncoding::kLinear}) {
    test::TwoEngines e;
    e.color = encoding;
    e.exposure = SomeExposure(encoding);
    e.Make(50);
    for (int i = 0; i < 30; ++i) e.batch.rgb[i] = 1;  // clipped
    e.ExpectTheSame();
  }
}

TEST(FitGains, FindsTheGainsOfAPhotograph) {
  const std::vector<float> rendered = {0.1f, 0.2f, 0.3f, 0.5f, 0.4f, 0.6f, 0.9f, 0.9f, 0.9f};
  std::vector<float> shown = rendered;
  ApplyGains({1.3f, 0.7f, 1.0f}, {}, shown);
  shown[6] = 1;  // 1.17, clipped
  const auto gains = FitGains(rendered, shown, {}, ColorEncoding::kSrgb);
  EXPECT_NEAR(gains[0], 1.3, 1e-6);
  EXPECT_NEAR(gains[1], 0.7, 1e-6);
  EXPECT_NEAR(gains[2], 1.0, 1e-6);
}

// A fixed background, onto which photographs with alpha are composited, has no exposure.
TEST(Exposure, DoesNotApplyToAFixedBackground) {
  test::TwoEngines e;
  e.exposure = SomeExposure(ColorEncoding::kSrgb);
  e.Make(50);
  e.grid->KeepVisible([](const Vector3f&, float) { return false; });  // nothing in front of it
  e.batch.rgb = e.batch.rays.background;
  for (const auto engine : {&test::TwoEngines::libtorch, &test::TwoEngines::fused}) {
    EXPECT_LT((e.*engine)->AccumulateGradients(e.batch).squared_error, 1e-12);
    const torch::Tensor slope = e.exposure->parameters()[0].grad();
    EXPECT_TRUE(!slope.defined() || slope.abs().max().item<double>() < 1e-6);
  }
}

TEST(FitGains, DoNotApplyToTheBackgroundContribution) {
  const std::vector<float> opacity = {1.0f, 0.5f, 0.0f}, white = {1, 1, 1};
  const std::vector<float> background = BackgroundContribution(opacity, white);
  EXPECT_EQ(background, (std::vector<float>{0, 0, 0, 0.5f, 0.5f, 0.5f, 1, 1, 1}));
  const std::vector<float> rendered = {0.2f, 0.3f, 0.4f, 0.7f, 0.6f, 0.8f, 1, 1, 1};
  std::vector<float> shown = rendered;
  ApplyGains({1.5f, 1.2f, 0.5f}, background, shown);
  EXPECT_EQ(std::vector<float>(shown.begin() + 6, shown.end()), white);
  EXPECT_NEAR(shown[3], 1.5 * 0.2 + 0.5, 1e-6);
  const auto gains = FitGains(rendered, shown, background, ColorEncoding::kSrgb);
  EXPECT_NEAR(gains[0], 1.5, 1e-5);
  EXPECT_NEAR(gains[1], 1.2, 1e-5);
  EXPECT_NEAR(gains[2], 0.5, 1e-5);
}

TEST(FitGains, AreOneWithoutUsablePixels) {
  const std::vector<float> black(6, 0.0f), white(6, 1.0f);
  const std::array<float, 3> one = {1, 1, 1};
  EXPECT_EQ(FitGains(black, white, {}, ColorEncoding::kSrgb), one);
  EXPECT_EQ(FitGains(black, white, {}, ColorEncoding::kLinear), one);
  EXPECT_EQ(FitGains({}, {}, {}, ColorEncoding::kLinear), one);
}

// A textured ball in front of surroundings that differ by direction, photographed with exposures up
// to a stop apart.
TEST(Exposure, GainsADecibelWherePhotographsDifferInExposure) {
  int photograph = 0;
  std::vector<float> gains;
  Vector3f last = Vector3f::Zero();
  const auto seen = [&](const Vector3f& origin, const Vector3f& direction) -> Vector4f {
    if (origin != last) {
      last = origin;
      // Held-out photographs, every fourth, have the mean exposure of the others.
      const bool out = gains.size() % 4 == 0;
      gains.push_back(out ? 1.0f
                          : std::exp(0.35f * std::sin(2.4f * static_cast<float>(photograph))));
      ++photograph;
    }
    const float middle = -origin.dot(direction);
    const Vector3f nearest = origin + middle * direction;
    const float square = 0.36f - nearest.squaredNorm();
    Vector3f color = Vector3f::Constant(0.35f) + 0.2f * direction;
    if (square > 0) {
      const Vector3f x = nearest - std::sqrt(square) * direction;
      color = 0.4f * Vector3f::Ones() + 0.2f * (8 * x).array().sin().matrix();
    }
    return (gains.back() * color).homogeneous();
  };
  const test::AnalyticCapture capture(test::CameraRing(24, 1.5, 0.8), 24, 24, seen);
  const auto psnr = [&](const std::string& effect) {
    const Config config =
        test::TinyConfig(600, {"march.near_distance=0.8", "effects.exposure=" + effect});
    return test::PsnrOver(test::Trained(config, capture.scene, capture.data), capture.held_out);
  };
  EXPECT_GT(psnr("{}"), psnr("null") + 1);
}

TEST(Exposure, OfAPhotographIsFoundByName) {
  const Config config = LoadConfig("base", {"effects.exposure={}", "encoding.log2_table_size=8"});
  SceneFacts scene;
  scene.photographs = {"a.png", "b.png"};
  const Model model = MakeModel(config, scene);
  const std::array<float, 3> one = {1, 1, 1};
  EXPECT_EQ(GainsOf(model, "b.png"), one);
  EXPECT_THAT(test::InputErrorOf([&] { GainsOf(model, "c.png"); }), testing::HasSubstr("c.png"));
  const Model plain = MakeModel(LoadConfig("base", {"encoding.log2_table_size=8"}), scene);
  EXPECT_THAT(test::InputErrorOf([&] { GainsOf(plain, "a.png"); }),
              testing::HasSubstr("effects.exposure={}"));
}

}  // namespace
}  // namespace nerf
