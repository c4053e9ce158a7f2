// Whole training steps and renderings of both engines on all threads, and LibTorch's own products.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "nerf/config.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/parallel.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/train/fused_engine.h"
#include "nerf/train/libtorch_engine.h"

namespace nerf {
namespace {

using benchmark::Counter;

// The default field, a grid whose matter is a shell, and rays from around it.
struct Scene {
  explicit Scene(std::int64_t rays) {
    at::set_num_threads(NumThreads());
    field = std::make_shared<RadianceField>(config.encoding, config.field, ColorEncoding::kSrgb, 1);
    grid = std::make_shared<OccupancyGrid>(config.occupancy, config.march.StepLength());
    grid->KeepVisible([](const Eigen::Vector3f& p, float) {
      const float radius = 4.0f * (p.array() - 0.5f).matrix().norm();
      return radius > 0.8f && radius < 1.0f;
    });
    batch.rays.Resize(rays);
    batch.rgb.assign(3 * rays, 0.4f);
    for (std::int64_t r = 0; r < rays; ++r) {
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
    }
  }
  template <class E>
  std::unique_ptr<Engine> Make() {
    return std::make_unique<E>(EngineParts{field, grid, proposal, config.march, config.proposal,
                                           config.loss, config.gradient_scaling});
  }
  Config config;
  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  std::shared_ptr<ProposalField> proposal;
  TargetBatch batch;
};

// Items are samples with gradients.
template <class E>
void TrainingStep(benchmark::State& state) {
  Scene scene(1024);
  const auto engine = scene.Make<E>();
  std::int64_t samples = 0;
  for (auto _ : state) samples += engine->AccumulateGradients(scene.batch).shaded;
  state.SetItemsProcessed(samples);
  state.counters["samples/ray"] =
      static_cast<double>(samples) / 1024.0 / static_cast<double>(state.iterations());
}
BENCHMARK(TrainingStep<LibTorchEngine>)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(TrainingStep<FusedEngine>)->UseRealTime()->Unit(benchmark::kMillisecond);

// Items are rays.
template <class E>
void Render(benchmark::State& state) {
  Scene scene(4096);
  const auto engine = scene.Make<E>();
  for (auto _ : state) benchmark::DoNotOptimize(engine->Render(scene.batch.rays).rgb.data());
  state.SetItemsProcessed(state.iterations() * scene.batch.rays.Size());
}
BENCHMARK(Render<LibTorchEngine>)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Render<FusedEngine>)->UseRealTime()->Unit(benchmark::kMillisecond);

// A layer of 64 neurons for 256 samples, as kernels_benchmark has it: by LibTorch's BLAS in float,
// by oneDNN in bfloat16; one thread.
void ProductForwardLibTorch(benchmark::State& state) {
  at::set_num_threads(1);
  const auto type = state.range(0) == 0 ? torch::kFloat : torch::kBFloat16;
  const torch::Tensor a = torch::rand({256, 64}).to(type), b = torch::rand({64, 64}).to(type);
  torch::Tensor c = torch::empty({256, 64}, type);
  for (auto _ : state) torch::mm_out(c, a, b);
  state.counters["FLOP/s"] =
      Counter(2.0 * 256 * 64 * 64 * static_cast<double>(state.iterations()), Counter::kIsRate);
}
BENCHMARK(ProductForwardLibTorch)->Arg(0)->Arg(1);

}  // namespace
}  // namespace nerf
