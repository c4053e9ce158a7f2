#include "nerf/render/pixel_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "nerf/field/exposure.h"
#include "nerf/field/tensor_span.h"
#include "nerf/render/losses.h"

namespace nerf {
namespace {

constexpr std::int64_t kRays = 40;
constexpr std::int64_t kPhotographs = 3;

// Colours on both sides of the Huber delta and of white.
struct Pixels {
  TargetBatch batch;
  std::vector<float> rgb, opacity;

  Pixels() {
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> uniform(0, 1);
    batch.rays.Resize(kRays);
    for (std::int64_t r = 0; r < kRays; ++r) {
      batch.photograph.push_back(r % kPhotographs);
      opacity.push_back(uniform(generator));
      for (int c = 0; c < 3; ++c) {
        batch.rgb.push_back(r % 5 == 0 ? 1.0f : uniform(generator));
        rgb.push_back(1.4f * uniform(generator));
        batch.rays.background[3 * r + c] = uniform(generator);
      }
    }
  }
  torch::Tensor Rgb() const { return TensorOf(rgb, {kRays, 3}, torch::kDouble).clone(); }
  torch::Tensor Target() const { return TensorOf(batch.rgb, {kRays, 3}, torch::kDouble).clone(); }
};

// Compares the plain loops with ColorLoss and Exposure by autograd, in double.
void ExpectEqualsAutograd(const PixelModel& model, Exposure* exposure) {
  Pixels pixels;
  torch::Tensor rgb = pixels.Rgb().requires_grad_(true);
  const torch::Tensor target = pixels.Target();
  torch::Tensor shown = rgb;
  if (exposure != nullptr) {
    exposure->zero_grad();
    shown =
        exposure->forward(rgb, TensorOf(pixels.batch.photograph, {kRays}, torch::kLong), target);
  }
  const torch::Tensor loss = ColorLoss(shown, target, model.loss, model.robust);
  loss.backward();

  PixelLoss plain;
  plain.Clear(model);
  std::vector<float> ray_error(kRays);
  // In two tiles.
  const std::span<const float> all(pixels.rgb), opacity(pixels.opacity);
  std::vector<float> dL_drgb;
  for (const auto& [first, count] : {std::pair{0, 24}, std::pair{24, 16}}) {
    ASSERT_TRUE(plain.Add(model, pixels.batch, first, all.subspan(3 * first, 3 * count),
                          opacity.subspan(first, count), ray_error));
    dL_drgb.insert(dL_drgb.end(), plain.dL_drgb.begin(), plain.dL_drgb.end());
  }
  EXPECT_NEAR(plain.loss / (3 * kRays), loss.item<double>(), 1e-6);
  const torch::Tensor expected = rgb.grad().flatten();
  for (std::int64_t i = 0; i < 3 * kRays; ++i) {
    EXPECT_NEAR(dL_drgb[i], expected[i].item<double>(), 1e-7) << i;
  }
  if (exposure == nullptr) return;
  exposure->zero_grad();
  const torch::Tensor of_autograd = [&] {
    const torch::Tensor again = exposure->forward(
        pixels.Rgb(), TensorOf(pixels.batch.photograph, {kRays}, torch::kLong), target);
    ColorLoss(again, target, model.loss, model.robust).backward();
    return exposure->parameters().front().grad().clone();
  }();
  exposure->zero_grad();
  exposure->parameters().front().mutable_grad() = torch::Tensor();
  exposure->AddGradient(plain.dL_dlog_gain);
  EXPECT_TRUE(torch::allclose(exposure->parameters().front().grad(), of_autograd, 1e-4, 1e-7));
}

TEST(PixelLoss, EqualsColorLossOfEachKind) {
  for (const LossKind kind : {LossKind::kHuber, LossKind::kMse}) {
    for (const bool robust : {false, true}) {
      PixelModel model;
      model.loss.kind = kind;
      if (robust) model.robust = RobustOptions();
      ExpectEqualsAutograd(model, nullptr);
    }
  }
}

TEST(PixelLoss, AppliesGainsAndAllowsBrighterColoursAtClippedPixels) {
  Exposure exposure(kPhotographs, ColorEncoding::kSrgb);
  {
    const torch::NoGradGuard no_grad;
    torch::manual_seed(1);
    exposure.parameters().front().normal_(0, 0.3);
  }
  PixelModel model;
  model.saturates = true;
  const torch::Tensor gains = exposure.Gains().detach().contiguous();
  model.gain.assign(gains.data_ptr<float>(), gains.data_ptr<float>() + gains.numel());
  ExpectEqualsAutograd(model, &exposure);
}

TEST(PixelLoss, ReportsNonFiniteValues) {
  Pixels pixels;
  PixelModel model;
  PixelLoss loss;
  loss.Clear(model);
  std::vector<float> ray_error(kRays);
  pixels.rgb[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(loss.Add(model, pixels.batch, 0, pixels.rgb, pixels.opacity, ray_error));
}

// Outliers, which have little weight in a robust loss, must not attract more rays.
TEST(PixelLoss, RayErrorsHaveTheWeightsOfTheRobustLoss) {
  Pixels pixels;
  PixelModel plain, robust;
  robust.robust = RobustOptions();
  std::vector<float> of_plain(kRays), of_robust(kRays);
  PixelLoss loss;
  loss.Clear(plain);
  loss.Add(plain, pixels.batch, 0, pixels.rgb, pixels.opacity, of_plain);
  loss.Clear(robust);
  loss.Add(robust, pixels.batch, 0, pixels.rgb, pixels.opacity, of_robust);
  const torch::Tensor weights =
      RobustRayWeights(pixels.Rgb(), pixels.Target(), robust.loss, *robust.robust);
  for (std::int64_t r = 0; r < kRays; ++r) {
    EXPECT_NEAR(of_robust[r], weights[r].item<double>() * of_plain[r], 1e-6);
    double squares = 0;
    for (int c = 0; c < 3; ++c) {
      const double error = pixels.rgb[3 * r + c] - pixels.batch.rgb[3 * r + c];
      squares += error * error / 3;
    }
    EXPECT_NEAR(of_plain[r], squares, 1e-6);
  }
}

}  // namespace
}  // namespace nerf
