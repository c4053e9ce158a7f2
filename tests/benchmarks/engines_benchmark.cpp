// Whole training steps and renderings of both engines on all threads, and LibTorch's own products.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <vector>

#include "nerf/base/parallel.h"
#include "nerf/config/config.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/render/fused_engine.h"
#include "nerf/render/libtorch_engine.h"
#include "nerf/sampling/occupancy_grid.h"
#include "tests/benchmarks/machine_limits.h"

namespace nerf {
namespace {

using benchmark::Counter;

// The default field, a grid whose matter is a shell, and rays from around it.
struct Scene {
  explicit Scene(std::int64_t rays, bool with_proposal = false) {
    at::set_num_threads(NumThreads());
    if (with_proposal) proposal = std::make_shared<ProposalField>(config.proposal, 1);
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
  std::unique_ptr<Engine> Make(kernels::Precision precision) {
    parts.config = config;
    parts.config.train.precision = precision;
    parts.field = field;
    parts.grid = grid;
    parts.proposal = proposal;
    return std::make_unique<E>(parts);
  }
  Config config;
  ModelParts parts;  // that the engine borrows
  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  std::shared_ptr<ProposalField> proposal;
  TargetBatch batch;
};

// What one thread of this machine could do at most, measured here.
struct Limits {
  double flops = 0;  // fused multiply-adds count twice
  double reads = 0;  // entries of four floats a second, of a table that is in the cache
};
Limits MeasureLimits() {
  using Clock = std::chrono::steady_clock;
  const auto rate_of = [](const auto& work) {  // units a second
    double best = 0;
    for (int attempt = 0; attempt < 5; ++attempt) {
      const auto begin = Clock::now();
      const double units = work();
      const std::chrono::duration<double> elapsed = Clock::now() - begin;
      best = std::max(best, units / elapsed.count());
    }
    return best;
  };
  Limits limits;
  limits.flops = rate_of([] {
    std::int64_t operations = 0;
    benchmark::DoNotOptimize(benchmarks::FusedMultiplyAdds(3000000, operations));
    return static_cast<double>(operations);
  });
  constexpr std::int64_t entries = 1 << 12;  // 64 KiB, in the second-level cache
  std::vector<float> table(4 * entries, 1.0f);
  std::vector<std::uint32_t> places(1 << 22);
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = static_cast<std::uint32_t>(i * 2654435761u % static_cast<std::uint64_t>(entries));
  }
  limits.reads = rate_of([&] {
    benchmark::DoNotOptimize(benchmarks::SumEntries(table, places));
    return static_cast<double>(places.size());
  });
  return limits;
}

// Seconds that a point takes at least, one thread: its networks at the peak of multiply-adds in
// float, forward and twice for the way back; its entries, the corners of a cell on each level, read
// forward, and read and written on the way back. bfloat16 has twice that peak.
double LeastSeconds(const Limits& limits, int levels, std::initializer_list<const Mlp*> networks) {
  double multiply_adds = 0;
  for (const Mlp* network : networks) {
    const std::vector<int> widths = network->Widths();
    for (std::size_t l = 0; l + 1 < widths.size(); ++l) multiply_adds += widths[l] * widths[l + 1];
  }
  return 3 * 2 * multiply_adds / limits.flops + 3 * 8.0 * levels / limits.reads;
}

// Of a sample of the default field on all threads together, and of its share of what its ray asks
// the proposal.
double LeastSecondsASample(const Scene& scene) {
  static const Limits limits = MeasureLimits();
  double seconds = LeastSeconds(limits, scene.config.encoding.levels,
                                {&scene.field->DensityNetwork(), &scene.field->ColorNetwork()});
  if (scene.proposal) {
    const ProposalOptions& options = scene.config.proposal;
    seconds += static_cast<double>(options.intervals) / options.samples *
               LeastSeconds(limits, options.encoding.levels, {&scene.proposal->Network()});
  }
  return seconds / NumThreads();
}

// Items are samples with gradients.
template <class E, kernels::Precision kPrecision = kernels::Precision::kFloat>
void TrainingStep(benchmark::State& state) {
  const bool with_proposal = state.range(0) != 0;
  Scene scene(1024, with_proposal);
  const auto engine = scene.Make<E>(kPrecision);
  std::int64_t samples = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (auto _ : state) samples += engine->AccumulateGradients(scene.batch).shaded;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  state.SetItemsProcessed(samples);
  state.counters["samples/ray"] =
      static_cast<double>(samples) / 1024.0 / static_cast<double>(state.iterations());
  state.counters["of_bound"] =
      static_cast<double>(samples) * LeastSecondsASample(scene) / elapsed.count();
}
constexpr auto kBfloat16 = kernels::Precision::kBfloat16;
#define NERF_TRAINING_STEP(...)        \
  BENCHMARK(TrainingStep<__VA_ARGS__>) \
      ->ArgName("proposal")            \
      ->Arg(0)                         \
      ->Arg(1)                         \
      ->UseRealTime()                  \
      ->Unit(benchmark::kMillisecond)
NERF_TRAINING_STEP(LibTorchEngine);
NERF_TRAINING_STEP(FusedEngine);
NERF_TRAINING_STEP(FusedEngine, kBfloat16);

// Items are rays.
template <class E>
void Render(benchmark::State& state) {
  Scene scene(4096);
  const auto engine = scene.Make<E>(kernels::Precision::kFloat);
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
