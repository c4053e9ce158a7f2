// The contract of both engines: invalid batches, unusual batches, other numbers of threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "nerf/base/parallel.h"
#include "nerf/render/non_finite_error.h"
#include "nerf/render/packet_renderer.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

using test::TwoEngines;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string RejectionOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(EngineContract, InvalidRaysAreRejectedWithTheirIndex) {
  TwoEngines e;
  e.Make(8);
  const PacketRenderer packets(*e.parts, RenderQuality());
  const auto expect_rejected = [&](std::vector<float> RayBatch::*values, std::size_t at,
                                   float invalid) {
    TargetBatch batch = e.batch;
    (batch.rays.*values)[at] = invalid;
    for (Engine* engine : {e.libtorch.get(), e.fused.get()}) {
      for (const auto& message : {RejectionOf([&] { engine->Render(batch.rays); }),
                                  RejectionOf([&] { engine->AccumulateGradients(batch); })}) {
        EXPECT_THAT(message, testing::HasSubstr("ray 5")) << invalid;
      }
    }
    EXPECT_THAT(RejectionOf([&] { packets.Render(batch.rays); }), testing::HasSubstr("ray 5"));
  };
  for (const float invalid : {NAN, kInfinity, -kInfinity}) {
    expect_rejected(&RayBatch::origin, 16, invalid);
    expect_rejected(&RayBatch::direction, 17, invalid);
    expect_rejected(&RayBatch::background, 15, invalid);
    expect_rejected(&RayBatch::jitter, 5, invalid);
  }
  expect_rejected(&RayBatch::origin, 15, std::numeric_limits<float>::max());
  expect_rejected(&RayBatch::direction, 15, 1e30f);
  expect_rejected(&RayBatch::jitter, 5, -0.5f);
}

TEST(EngineContract, DirectionsThatAreNotUnitVectorsAreRejected) {
  TwoEngines e;
  e.Make(8);
  for (const float length : {0.0f, 1e-40f, 1e-3f}) {
    RayBatch rays = e.batch.rays;
    for (int c = 0; c < 3; ++c) rays.direction[6 + c] *= length;
    EXPECT_THAT(RejectionOf([&] { e.fused->Render(rays); }), testing::HasSubstr("ray 2"));
  }
}

TEST(EngineContract, ANonFiniteTargetIsReportedWithItsRay) {
  TwoEngines e;
  e.Make(8);
  e.batch.rgb[3 * 6 + 1] = NAN;
  for (Engine* engine : {e.libtorch.get(), e.fused.get()}) {
    try {
      engine->AccumulateGradients(e.batch);
      FAIL();
    } catch (const NonFiniteError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("ray 6, stage target colours"));
    }
  }
}

TEST(EngineContract, RaysMayStartAtTheOriginOrOnTheUnitSphereAndBeParallelToAnAxis) {
  TwoEngines e;
  e.Make(6);
  e.batch.rays.origin = {0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 0, 1, 1e-40f, 0, -0.0f, 100, 0, 0};
  e.batch.rays.direction = {1, 0, 0, 1, 0, 0, 0, 1, -0.0f, 0, 1, 0, 0, 0, -1, -1, 0, 0};
  e.ExpectTheSame();
}

TEST(EngineContract, GradientsVanishWhereTheImageIsExact) {
  TwoEngines e;
  e.Make(20);
  for (Engine* engine : {e.libtorch.get(), e.fused.get()}) {
    e.batch.rgb = engine->Render(e.batch.rays).rgb;
    const StepResult result = engine->AccumulateGradients(e.batch);
    EXPECT_LT(result.loss, 1e-12);
    for (const auto& [name, gradient] : e.Gradients()) {
      EXPECT_TRUE(torch::isfinite(gradient).all().item<bool>()) << name;
      EXPECT_LT(gradient.abs().max().item<double>(), 1e-4) << name;
    }
  }
}

TEST(EngineContract, ABatchMayHaveOneRay) {
  TwoEngines e;
  e.Make(1);
  e.ExpectTheSame();
}

// The number of threads changes the order in which gradients are summed.
TEST(EngineContract, TheNumberOfThreadsChangesGradientsOnlyByRounding) {
  TwoEngines e;
  e.Make(97, /*with_proposal=*/true);
  const int threads = NumThreads();
  for (Engine* engine : {e.libtorch.get(), e.fused.get()}) {
    SetNumThreads(1);
    engine->AccumulateGradients(e.batch);
    const auto one = e.Gradients();
    SetNumThreads(5);
    engine->AccumulateGradients(e.batch);
    for (const auto& [name, gradient] : e.Gradients()) {
      const double size = one.at(name).abs().max().item<double>();
      EXPECT_LE((gradient - one.at(name)).abs().max().item<double>(), 1e-5 * size) << name;
    }
  }
  SetNumThreads(threads);
}

}  // namespace
}  // namespace nerf
