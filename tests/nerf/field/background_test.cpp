#include "nerf/field/background.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nerf/field/tensor_span.h"
#include "nerf/render/view_renderer.h"
#include "tests/support/analytic_capture.h"
#include "tests/support/central_differences.h"
#include "tests/support/input_error_of.h"
#include "tests/support/tiny_training.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr BackgroundOptions kSmall = {4};

std::shared_ptr<Background> SomeBackground(ColorEncoding encoding) {
  auto background = std::make_shared<Background>(kSmall, encoding);
  const torch::NoGradGuard no_grad;
  torch::manual_seed(2);
  background->parameters()[0].normal_();
  return background;
}

// Directions all over the sphere, including the poles and the seam of longitude.
std::vector<float> Directions() {
  std::vector<float> directions = {0, 0, 1, 0, 0, -1, -1, 0, 0, -1, -1e-7f, 0, -1, 1e-7f, 0};
  for (int i = 0; i < 40; ++i) {
    const Vector3f d =
        Vector3f(std::sin(1.3f * i), std::cos(2.1f * i), std::sin(0.7f * i)).normalized();
    directions.insert(directions.end(), d.data(), d.data() + 3);
  }
  return directions;
}

TEST(BackgroundMap, InterpolatesFourTexelsWithWeightsThatSumToOne) {
  const std::vector<float> directions = Directions();
  for (std::size_t i = 0; i < directions.size(); i += 3) {
    const auto texels =
        BackgroundMap::TexelsOf(std::span(directions).subspan(i).first<3>(), kSmall.resolution);
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      EXPECT_GE(texels.weight[k], 0);
      EXPECT_GE(texels.index[k], 0);
      EXPECT_LT(texels.index[k], 2 * kSmall.resolution * kSmall.resolution);
      sum += texels.weight[k];
    }
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

TEST(BackgroundMap, AtTheCentreOfATexelIsThatTexel) {
  const int rows = kSmall.resolution;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < 2 * rows; ++column) {
      const double polar = (row + 0.5) / rows * std::numbers::pi;
      const double longitude = ((column + 0.5) / rows - 1) * std::numbers::pi;
      const std::array<float, 3> direction = {
          static_cast<float>(std::sin(polar) * std::cos(longitude)),
          static_cast<float>(std::sin(polar) * std::sin(longitude)),
          static_cast<float>(std::cos(polar))};
      const auto texels = BackgroundMap::TexelsOf(direction, rows);
      float weight = 0;
      for (int k = 0; k < 4; ++k) {
        if (texels.index[k] == row * 2 * rows + column) weight += texels.weight[k];
      }
      EXPECT_NEAR(weight, 1, 1e-5) << row << " " << column;
    }
  }
}

TEST(BackgroundMap, HasNoSeam) {
  const auto map = SomeBackground(ColorEncoding::kSrgb)->Map();
  std::vector<float> rgb(6);
  map.Radiance(std::vector<float>{-1, -1e-6f, 0.0f, -1, 1e-6f, 0.0f}, rgb);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], rgb[3 + c], 1e-5);
}

TEST(Background, EqualsItsMap) {
  for (const auto encoding : {ColorEncoding::kSrgb, ColorEncoding::kLinear}) {
    const auto background = SomeBackground(encoding);
    const std::vector<float> directions = Directions();
    const auto rays = static_cast<std::int64_t>(directions.size() / 3);
    std::vector<float> rgb(directions.size());
    background->Map().Radiance(directions, rgb);
    const torch::NoGradGuard no_grad;
    const torch::Tensor expected =
        background->forward(TensorOf(directions, {rays, 3}, torch::kFloat)).contiguous();
    for (std::size_t i = 0; i < rgb.size(); ++i) {
      EXPECT_NEAR(rgb[i], Span<const float>(expected)[i], 1e-5 * (1 + rgb[i]));
    }
  }
}

TEST(Background, GradientsMatchCentralDifferences) {
  const auto background = SomeBackground(ColorEncoding::kSrgb);
  background->to(torch::kDouble);
  const std::vector<float> directions = Directions();
  const torch::Tensor d =
      TensorOf(directions, {static_cast<std::int64_t>(directions.size() / 3), 3}, torch::kDouble);
  test::ExpectGradientMatchesCentralDifferences(
      [&] { return background->forward(d).square().sum(); }, background->parameters()[0], 1e-6,
      1e-7);
}

TEST(Background, IsTheSameInBothEngines) {
  for (const auto encoding : {ColorEncoding::kSrgb, ColorEncoding::kLinear}) {
    test::TwoEngines e;
    e.color = encoding;
    e.background = SomeBackground(encoding);
    e.Make(50);
    e.ExpectTheSame();
  }
}

TEST(Background, OfOneColourEqualsAFixedBackground) {
  test::TwoEngines plain, learned;
  plain.Make(30);
  std::ranges::fill(plain.batch.rays.background, 0.5f);
  learned.background = std::make_shared<Background>(kSmall, ColorEncoding::kSrgb);  // grey
  learned.Make(30);
  EXPECT_EQ(learned.fused->Render(learned.batch.rays).rgb,
            plain.fused->Render(plain.batch.rays).rgb);
}

// A ball in front of a sky at infinity that differs by direction.
TEST(Background, GainsADecibelUnderASky) {
  const auto seen = [](const Vector3f& origin, const Vector3f& direction) -> Vector4f {
    const float middle = -origin.dot(direction);
    const Vector3f nearest = origin + middle * direction;
    const float square = 0.16f - nearest.squaredNorm();
    if (square <= 0) {
      return (Vector3f::Constant(0.5f) + 0.4f * (3 * direction).array().sin().matrix())
          .homogeneous();
    }
    const Vector3f x = nearest - std::sqrt(square) * direction;
    return (0.5f * Vector3f::Ones() + 0.3f * (8 * x).array().sin().matrix()).homogeneous();
  };
  const test::AnalyticCapture capture(test::CameraRing(24, 1.5, 0.8), 24, 24, seen);
  Model with_sky;
  const auto psnr = [&](const std::string& effect) {
    const Config config =
        test::TinyConfig(600, {"march.near_distance=0.8", "effects.background=" + effect});
    with_sky = test::Trained(config, capture.scene, capture.data);
    return test::PsnrOver(with_sky, capture.held_out);
  };
  const double without = psnr("null"), with = psnr("{}");
  EXPECT_GT(with, without + 1);
  // The renderer at lower quality shows the same sky.
  RayBatch up;
  up.Resize(1);
  up.origin = {0, 0, 1};
  up.direction = {0, 0, 1};
  up.jitter = {0.5f};
  const auto exact = MakeRenderer(with_sky)->Render(up).rgb;
  const auto quick = MakeRenderer(with_sky, 0.9)->Render(up).rgb;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(quick[c], exact[c], 0.1);
}

TEST(Background, IsRejectedForPhotographsWithAlpha) {
  SceneFacts scene;
  scene.has_alpha = true;
  const Config config = LoadConfig("base", {"effects.background={}"});
  EXPECT_THAT(test::InputErrorOf([&] { MakeModel(config, scene); }), testing::HasSubstr("alpha"));
}

}  // namespace
}  // namespace nerf
