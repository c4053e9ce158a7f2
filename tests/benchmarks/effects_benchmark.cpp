// A step of training, of the engine that trains by default, with each effect and without any.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "nerf/base/parallel.h"
#include "nerf/config/config.h"
#include "nerf/model/model.h"
#include "nerf/model/parameters.h"
#include "nerf/render/engine.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {
namespace {

constexpr std::int64_t kRays = 1024;
constexpr int kPhotographs = 16, kEdge = 64;

// Photographs of one grey, from around the scene.
Dataset Photographs() {
  Dataset data;
  for (int i = 0; i < kPhotographs; ++i) {
    View view;
    view.name = std::to_string(i);
    view.camera = PinholeFromFov(kEdge, kEdge, 1);
    const Eigen::Vector3d centre(2 * std::sin(i), 2 * std::cos(i), 0.1 * i);
    view.normalized_from_camera.setIdentity();
    view.normalized_from_camera.rotate(
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -centre));
    view.normalized_from_camera.translation() = centre;
    view.rgba.assign(4 * kEdge * kEdge, Eigen::half(0.4f));
    for (int pixel = 0; pixel < kEdge * kEdge; ++pixel) view.rgba[4 * pixel + 3] = Eigen::half(1);
    data.train.push_back(view);
  }
  return data;
}

// Pixels are drawn, and gradients are taken. Items are rays; MB are the parameters with their
// gradients and the optimiser's two moments.
void Step(benchmark::State& state, const EffectDescriptor& effect, bool on) {
  at::set_num_threads(NumThreads());
  const Dataset data = Photographs();
  const Model model = MakeModel(WithEffect(Config(), effect, on), FactsOf(data, {}));
  const std::unique_ptr<Engine> engine = MakeEngine(model);
  const PixelSampler sampler(data.train);
  std::uint64_t step = 0;
  for (auto _ : state) {
    const TargetBatch batch = sampler.Sample(kRays, 1, step++);
    benchmark::DoNotOptimize(engine->AccumulateGradients(batch).loss);
  }
  state.SetItemsProcessed(state.iterations() * kRays);
  double bytes = 0;
  for (const auto& [name, parameter] : NamedParameters(model)) {
    bytes += 4.0 * static_cast<double>(parameter.nbytes());
  }
  state.counters["MB"] = bytes * 0x1p-20;
}
#define NERF_STEP(name, ...) \
  BENCHMARK_CAPTURE(Step, name, __VA_ARGS__)->UseRealTime()->Unit(benchmark::kMillisecond)
NERF_STEP(as_by_default, kViewDependenceEffect, true);
NERF_STEP(without_view_dependence, kViewDependenceEffect, false);
NERF_STEP(with_background, kBackgroundEffect, true);
NERF_STEP(with_exposure, kExposureEffect, true);
NERF_STEP(with_robust, kRobustEffect, true);
NERF_STEP(with_pose_refinement, kPoseRefinementEffect, true);
NERF_STEP(with_anti_aliasing, kAntiAliasingEffect, true);
NERF_STEP(without_unbounded, kUnboundedEffect, false);

}  // namespace
}  // namespace nerf
