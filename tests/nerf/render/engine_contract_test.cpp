// What both engines owe whoever calls them: hostile batches, odd batches, other threads.
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

std::string RefusalOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(EngineContract, RefusePoisonedRaysWithTheirIndex) {
  TwoEngines e;
  e.Make(8);
  const PacketRenderer packets(*e.parts, RenderQuality());
  const auto expect_refused = [&](std::vector<float> RayBatch::*values, std::size_t at,
                                  float poison) {
    TargetBatch batch = e.batch;
    (batch.rays.*values)[at] = poison;
    for (Engine* engine : {e.libtorch.get(), e.fused.get()}) {
      for (const auto& refusal : {RefusalOf([&] { engine->Render(batch.rays); }),
                                  RefusalOf([&] { engine->AccumulateGradients(batch); })}) {
        EXPECT_THAT(refusal, testing::HasSubstr("ray 5")) << poison;
      }
    }
    EXPECT_THAT(RefusalOf([&] { packets.Render(batch.rays); }), testing::HasSubstr("ray 5"));
  };
  for (const float poison : {NAN, kInfinity, -kInfinity}) {
    expect_refused(&RayBatch::origin, 16, poison);
    expect_refused(&RayBatch::direction, 17, poison);
    expect_refused(&RayBatch::background, 15, poison);
    expect_refused(&RayBatch::jitter, 5, poison);
  }
  expect_refused(&RayBatch::origin, 15, std::numeric_limits<float>::max());
  expect_refused(&RayBatch::direction, 15, 1e30f);
  expect_refused(&RayBatch::jitter, 5, -0.5f);
}

TEST(EngineContract, RefuseADirectionWithoutLength) {
  TwoEngines e;
  e.Make(8);
  for (const float length : {0.0f, 1e-40f, 1e-3f}) {
    RayBatch rays = e.batch.rays;
    for (int c = 0; c < 3; ++c) rays.direction[6 + c] *= length;
    EXPECT_THAT(RefusalOf([&] { e.fused->Render(rays); }), testing::HasSubstr("ray 2"));
  }
}

TEST(EngineContract, NameTheRayWhoseTargetIsNoNumber) {
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

TEST(EngineContract, ARayMayStandAtTheOriginLookAlongAnAxisAndStartOnTheUnitSphere) {
  TwoEngines e;
  e.Make(6);
  e.batch.rays.origin = {0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 0, 1, 1e-40f, 0, -0.0f, 100, 0, 0};
  e.batch.rays.direction = {1, 0, 0, 1, 0, 0, 0, 1, -0.0f, 0, 1, 0, 0, 0, -1, -1, 0, 0};
  e.ExpectTheSame();
}

TEST(EngineContract, AnImageThatIsRightAlreadyTrainsOnWithoutGradients) {
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

TEST(EngineContract, OneRayIsEnough) {
  TwoEngines e;
  e.Make(1);
  e.ExpectTheSame();
}

// The bound on what another number of threads may change: the order of sums of gradients.
TEST(EngineContract, OtherThreadsChangeGradientsByRoundingAlone) {
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
