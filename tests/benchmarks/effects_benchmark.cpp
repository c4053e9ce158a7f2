// A step of training, of the engine that trains by default, with each effect and without any.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "nerf/base/parallel.h"
#include "nerf/config/config.h"
#include "nerf/model/model.h"
#include "nerf/pipeline/effect_trial.h"
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
void Step(benchmark::State& state, const std::string& effect, const std::string& setting) {
  at::set_num_threads(NumThreads());
  const Dataset data = Photographs();
  const Model model = MakeModel(WithEffect(Config(), effect, setting), FactsOf(data, {}));
  const PixelSampler sampler(data.train);
  std::uint64_t step = 0;
  for (auto _ : state) {
    const TargetBatch batch = sampler.Sample(kRays, 1, step++);
    benchmark::DoNotOptimize(model.engine->AccumulateGradients(batch).loss);
  }
  state.SetItemsProcessed(state.iterations() * kRays);
  state.counters["MB"] = MegabytesOf(model);
}
#define NERF_STEP(name, ...) \
  BENCHMARK_CAPTURE(Step, name, __VA_ARGS__)->UseRealTime()->Unit(benchmark::kMillisecond)
NERF_STEP(as_by_default, "view", "{}");
NERF_STEP(without_view, "view", "null");
NERF_STEP(with_background, "background", "{}");
NERF_STEP(with_exposure, "exposure", "{}");
NERF_STEP(with_robust, "robust", "{}");
NERF_STEP(with_poses, "poses", "{}");
NERF_STEP(with_footprint, "footprint", "{}");
NERF_STEP(without_unbounded, "unbounded", "null");

}  // namespace
}  // namespace nerf
