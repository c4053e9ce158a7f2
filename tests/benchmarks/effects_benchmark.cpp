// A step of training, of the engine that trains by default, with each effect and without any.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "nerf/config.h"
#include "nerf/parallel.h"
#include "nerf/train/effect_trial.h"
#include "nerf/train/engine.h"
#include "nerf/train/model.h"

namespace nerf {
namespace {

constexpr std::int64_t kRays = 1024, kPhotographs = 16;

// Rays from around the scene, of photographs of one grey.
TargetBatch Rays() {
  TargetBatch batch;
  batch.rays.Resize(kRays);
  batch.rgb.assign(3 * kRays, 0.4f);
  for (std::int64_t r = 0; r < kRays; ++r) {
    const auto x = static_cast<float>(r);
    const Eigen::Vector3f origin =
        1.5f * Eigen::Vector3f(std::sin(x), std::cos(2.3f * x), std::sin(0.7f * x)).normalized();
    const Eigen::Vector3f aim(0.5f * std::sin(3 * x), 0.5f * std::sin(5 * x), 0.0f);
    const Eigen::Vector3f d = (aim - origin).normalized();
    for (int c = 0; c < 3; ++c) {
      batch.rays.origin[3 * r + c] = origin[c];
      batch.rays.direction[3 * r + c] = d[c];
      batch.rays.background[3 * r + c] = 0.5f;
    }
    batch.rays.jitter[r] = 0.5f;
    batch.rays.spread.push_back(0.002f);
    batch.photograph.push_back(r % kPhotographs);
  }
  return batch;
}

// Items are rays; MB are the parameters with their gradients and the optimiser's two moments.
void Step(benchmark::State& state, const std::string& effect, const std::string& setting) {
  at::set_num_threads(NumThreads());
  SceneFacts scene;
  for (int i = 0; i < kPhotographs; ++i) {
    scene.photographs.push_back(std::to_string(i));
    CameraPlace place;
    place.centre = {2 * std::sin(i), 2 * std::cos(i), 0.1 * i};
    place.axis = -place.centre.normalized();
    scene.places.push_back(place);
  }
  const Config config = WithEffect(Config(), effect, setting);
  const Model model = MakeModel(config, scene);
  const TargetBatch batch = Rays();
  for (auto _ : state) benchmark::DoNotOptimize(model.engine->AccumulateGradients(batch).loss);
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
