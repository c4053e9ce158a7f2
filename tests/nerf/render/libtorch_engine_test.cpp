#include "nerf/render/libtorch_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/render/non_finite_error.h"
#include "nerf/sampling/occupancy_grid.h"
#include "tests/support/small_engine.h"

namespace nerf {
namespace {

using Fixture = test::SmallEngine;
using test::ExpectGradientsOfTheWholePath;

TEST(LibTorchEngine, GradientsOfTheWholePathMatchCentralDifferences) {
  Fixture f(torch::kDouble);
  ExpectGradientsOfTheWholePath(f);
}

TEST(LibTorchEngine, GradientsOfKnownDistancesMatchCentralDifferences) {
  Fixture f(torch::kDouble, 1e-4, false, [](ModelParts& parts) {
    parts.config.effects.depth_supervision = DepthSupervisionOptions{0.1, 1.0, 0.05};
  });
  f.batch.distance = {2.0f, 0.0f, 1.5f, 2.5f, 2.0f, 3.0f};
  ExpectGradientsOfTheWholePath(f);
}

TEST(LibTorchEngine, FloatAgreesWithDouble) {
  Fixture single(torch::kFloat), twice(torch::kDouble);
  {
    const torch::NoGradGuard no_grad;
    for (auto& p : single.field->named_parameters()) {
      p.value().copy_(twice.field->named_parameters()[p.key()]);
    }
  }
  const RenderOutput a = single.engine->Render(single.batch.rays);
  const RenderOutput b = twice.engine->Render(twice.batch.rays);
  for (std::size_t i = 0; i < a.rgb.size(); ++i) EXPECT_NEAR(a.rgb[i], b.rgb[i], 1e-5);
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    EXPECT_NEAR(a.opacity[i], b.opacity[i], 1e-5);
    EXPECT_NEAR(a.depth[i], b.depth[i], 1e-4 * (1 + b.depth[i]));
  }
}

TEST(LibTorchEngine, StoppingEarlyChangesColoursByLessThanTheTransmittance) {
  Fixture exact(torch::kDouble, 1e-12), early(torch::kDouble, 0.05);
  for (const Fixture* f : {&exact, &early}) {  // dense enough that rays stop early
    const torch::NoGradGuard no_grad;
    f->field->named_parameters()["density_network.layer1.weight"].slice(0, 0, 1).fill_(0.5);
  }
  const RenderOutput a = exact.engine->Render(exact.batch.rays);
  const RenderOutput b = early.engine->Render(early.batch.rays);
  EXPECT_LT(b.samples, a.samples);
  for (std::size_t i = 0; i < a.rgb.size(); ++i) EXPECT_NEAR(a.rgb[i], b.rgb[i], 0.05);
}

TEST(LibTorchEngine, DepthStaysBetweenNearAndFar) {
  Fixture f(torch::kFloat);
  const RenderOutput out = f.engine->Render(f.batch.rays);
  for (std::size_t r = 0; r < out.depth.size(); ++r) {
    EXPECT_GE(out.depth[r], f.march.near_distance);
    EXPECT_LE(out.depth[r], f.march.far_distance);
  }
}

TEST(LibTorchEngine, RaysThroughAnEmptyGridShowTheBackground) {
  Fixture f(torch::kFloat);
  f.grid->KeepVisible([](const Eigen::Vector3f&, float) { return false; });
  const RenderOutput out = f.engine->Render(f.batch.rays);
  EXPECT_EQ(out.rgb, f.batch.rays.background);
  EXPECT_EQ(out.depth, std::vector<float>(6, 0.0f));
  EXPECT_NO_THROW(f.engine->AccumulateGradients(f.batch));
}

TEST(LibTorchEngine, ANonFiniteParameterIsReportedWithRayAndStage) {
  Fixture f(torch::kFloat);
  {
    const torch::NoGradGuard no_grad;
    f.field->named_parameters()["color_network.layer0.weight"].fill_(NAN);
  }
  try {
    f.engine->AccumulateGradients(f.batch);
    FAIL();
  } catch (const NonFiniteError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("ray "), testing::HasSubstr("colour")));
  }
}

}  // namespace
}  // namespace nerf
