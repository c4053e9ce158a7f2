#include "nerf/render/fused_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/base/parallel.h"
#include "nerf/render/non_finite_error.h"
#include "tests/support/simd_levels.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

using test::TwoEngines;

class FusedEngineAtEveryLevel : public test::EverySimdLevel {};

TEST_P(FusedEngineAtEveryLevel, EqualsLibTorchEngine) {
  TwoEngines e;
  e.Make(50);
  e.ExpectTheSame();
}

TEST_P(FusedEngineAtEveryLevel, EqualsLibTorchEngineWithAProposalNetwork) {
  for (const double exponent : {0.0, 0.3, 1.0}) {
    TwoEngines e;
    e.Make(50, /*with_proposal=*/true);
    SCOPED_TRACE(exponent);
    e.context.annealing.proposal = exponent;
    // With exponent 0 sample positions depend on no density and are the same in both engines.
    e.ExpectTheSame(exponent == 0 ? 1e-4 : 0.1);
  }
}

NERF_FOR_EVERY_SIMD_LEVEL(FusedEngineAtEveryLevel);

TEST(FusedEngine, EqualsLibTorchEngineForLinearRadianceSquaredErrorsAndOtherNetworks) {
  TwoEngines e;
  e.color = ColorEncoding::kLinear;
  e.loss.kind = LossKind::kMse;
  e.gradient_scaling.full_distance = 0;
  e.encoding.features = 2;
  e.field_options.hidden_width = 40;
  e.field_options.color_layers = 1;
  e.Make(20);
  e.ExpectTheSame();
}

TEST(FusedEngine, EqualsLibTorchEngineWhileDetailIsFadedIn) {
  TwoEngines e;
  e.Make(20);
  e.context.annealing.detail = 0.45;
  e.ExpectTheSame();
}

TEST(FusedEngine, EqualsLibTorchEngineWithManySamplesPerRayOnAnyNumberOfThreads) {
  TwoEngines e;
  e.march.steps_per_unit = 300;
  e.march.stop_transmittance = 1e-6;
  e.Make(5);
  const int threads = NumThreads();
  for (const int count : {1, 3, 16}) {
    SetNumThreads(count);
    e.ExpectTheSame();
  }
  SetNumThreads(threads);
}

TEST(FusedEngine, UpdatesOccupancyLikeLibTorchEngine) {
  TwoEngines e;
  e.Make(1);
  StepContext context;
  context.step = 16;
  context.seed = 3;
  e.libtorch->UpdateOccupancy(context);
  const std::vector<float> expected = e.grid->Density();
  std::fill(e.grid->Density().begin(), e.grid->Density().end(), 0.0f);
  e.grid->Refresh();
  e.fused->UpdateOccupancy(context);
  ASSERT_EQ(e.grid->Density().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(e.grid->Density()[i], expected[i], 1e-4 * (1 + expected[i]));
  }
}

TEST(FusedEngine, RepeatsBitForBit) {
  TwoEngines e;
  e.Make(64);
  e.fused->AccumulateGradients(e.batch);
  const auto first = e.Gradients();
  e.fused->AccumulateGradients(e.batch);
  for (const auto& [name, gradient] : e.Gradients()) EXPECT_TRUE(gradient.equal(first.at(name)));
}

TEST(FusedEngine, RaysThroughAnEmptyGridShowTheBackground) {
  TwoEngines e;
  e.Make(6);
  e.grid->KeepVisible([](const Eigen::Vector3f&, float) { return false; });
  const RenderOutput out = e.fused->Render(e.batch.rays);
  EXPECT_EQ(out.rgb, e.batch.rays.background);
  EXPECT_EQ(out.depth, std::vector<float>(6, 0.0f));
  EXPECT_NO_THROW(e.fused->AccumulateGradients(e.batch));
}

TEST(FusedEngine, ANonFiniteParameterIsReportedWithRayAndStage) {
  for (const auto& [name, stage] : {std::pair{"color_network.layer0.weight", "colour"},
                                    std::pair{"density_network.layer0.weight", "density"},
                                    std::pair{"hash_encoding.table", "density"}}) {
    TwoEngines e;
    e.Make(10);
    {
      const torch::NoGradGuard no_grad;
      e.field->named_parameters()[name].fill_(NAN);
    }
    try {
      e.fused->AccumulateGradients(e.batch);
      FAIL() << name;
    } catch (const NonFiniteError& error) {
      EXPECT_THAT(error.what(),
                  testing::AllOf(testing::HasSubstr("ray "), testing::HasSubstr(stage)));
    }
  }
}

}  // namespace
}  // namespace nerf
