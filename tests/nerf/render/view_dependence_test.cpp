#include <gtest/gtest.h>

#include <cmath>

#include "nerf/field/radiance_field.h"
#include "nerf/model/parameters.h"
#include "tests/support/analytic_capture.h"
#include "tests/support/tiny_training.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

TEST(ViewDependence, TurnedOffColoursDoNotDependOnTheDirection) {
  test::TwoEngines e;
  e.color_model = ColorModel::kDiffuse;
  e.Make(1);
  const torch::NoGradGuard no_grad;
  const torch::Tensor positions = torch::rand({8, 3});
  const torch::Tensor ray = torch::zeros({8}, torch::kLong);
  const auto radiance = [&](float x, float y, float z) {
    return e.field->forward(positions, torch::tensor({{x, y, z}}), ray).radiance;
  };
  EXPECT_TRUE(radiance(1, 0, 0).equal(radiance(0, 0.6f, -0.8f)));
}

// The neutral parameter: weights of 0 for the direction.
TEST(ViewDependence, WithZeroWeightsGivesTheDiffuseImage) {
  test::TwoEngines by_direction, diffuse;
  diffuse.color_model = ColorModel::kDiffuse;
  by_direction.Make(50);
  diffuse.Make(50);
  const torch::NoGradGuard no_grad;
  const auto from = diffuse.field->named_parameters();
  for (auto& p : by_direction.field->named_parameters()) {
    const torch::Tensor& plain = from[p.key()];
    if (p.value().sizes() != plain.sizes()) p.value().zero_();
    p.value().slice(1, 0, plain.size(1)).copy_(plain);
  }
  for (const auto engine : {&test::TwoEngines::libtorch, &test::TwoEngines::fused}) {
    const std::vector<float> a = (by_direction.*engine)->Render(by_direction.batch.rays).rgb;
    const std::vector<float> b = (diffuse.*engine)->Render(diffuse.batch.rays).rgb;
    ASSERT_EQ(a.size(), b.size());
    // Exact in the fused engine; OpenBLAS sums a longer row in another order.
    const float bound = engine == &test::TwoEngines::fused ? 0.0f : 1e-6f;
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], bound);
  }
}

TEST(ViewDependence, TurnedOffHasNoWeights) {
  const auto weights = [](const char* effect) {
    const Model model = MakeModel(LoadConfig("base", {effect}), SceneFacts());
    std::int64_t count = 0;
    for (const auto& [name, parameter] : NamedParameters(model)) count += parameter.numel();
    return count;
  };
  EXPECT_EQ(weights("effects.view_dependence={}") - weights("effects.view_dependence=null"),
            16 * 64);
}

TEST(ViewDependence, TurnedOffIsTheSameInBothEngines) {
  test::TwoEngines e;
  e.color_model = ColorModel::kDiffuse;
  e.Make(50);
  e.ExpectTheSame();
}

// A mirroring ball.
TEST(ViewDependence, GainsADecibelForAGlossyBall) {
  const auto seen = [](const Vector3f& origin, const Vector3f& direction) -> Vector4f {
    const float middle = -origin.dot(direction);
    const Vector3f nearest = origin + middle * direction;
    const float square = 0.36f - nearest.squaredNorm();
    if (square <= 0) return Vector4f::Zero();
    const Vector3f x = nearest - std::sqrt(square) * direction;
    const Vector3f normal = x.normalized();
    const Vector3f mirrored = direction - 2 * direction.dot(normal) * normal;
    return (Vector3f::Constant(0.5f) + 0.45f * (2 * mirrored).array().sin().matrix()).homogeneous();
  };
  const test::AnalyticCapture capture(test::CameraRing(40, 1.5, 0.8), 24, 24, seen,
                                      /*has_alpha=*/true);
  const auto psnr = [&](const std::string& effect) {
    const Config config = test::TinyConfig(800, {"effects.view_dependence=" + effect});
    return test::PsnrOver(test::Trained(config, capture.scene, capture.data), capture.held_out);
  };
  EXPECT_GT(psnr("{}"), psnr("null") + 1);
}

}  // namespace
}  // namespace nerf
