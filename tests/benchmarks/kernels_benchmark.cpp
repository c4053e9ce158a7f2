// The kernels on one thread, beside the machine's limits measured in the same run.
#include <benchmark/benchmark.h>
#ifdef NERF_HAVE_LIBXSMM
#include <libxsmm.h>
#endif

#include <random>
#include <vector>

#include "nerf/kernels/adam.h"
#include "nerf/kernels/descriptor_matching.h"
#include "nerf/kernels/hash_encoding_tile.h"
#include "nerf/kernels/matrix_product.h"
#include "nerf/kernels/mlp.h"
#include "nerf/kernels/volume_rendering.h"
#include "tests/benchmarks/machine_limits.h"

namespace nerf::kernels {
namespace {

constexpr std::int64_t kTile = 256;  // samples, as the fused engine takes them

using benchmark::Counter;

std::vector<float> Uniform(std::size_t count, float low = 0, float high = 1) {
  std::mt19937 generator(static_cast<std::uint32_t>(count));
  std::uniform_real_distribution<float> uniform(low, high);
  std::vector<float> values(count);
  for (float& value : values) value = uniform(generator);
  return values;
}

void SetFlops(benchmark::State& state, double per_iteration) {
  state.counters["FLOP/s"] =
      Counter(per_iteration * static_cast<double>(state.iterations()), Counter::kIsRate);
}

void LimitFusedMultiplyAdd(benchmark::State& state) {
  std::int64_t operations = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(benchmarks::FusedMultiplyAdds(10000, operations));
  }
  SetFlops(state, static_cast<double>(operations));
}
BENCHMARK(LimitFusedMultiplyAdd);

// Entries of 16 bytes a second, by the table's size as a power of two.
void LimitRandomReads(benchmark::State& state) {
  const std::size_t entries = std::size_t{1} << state.range(0);
  const auto table = Uniform(4 * entries);
  std::mt19937 generator(1);
  std::vector<std::uint32_t> places(1 << 16);
  for (auto& place : places) place = static_cast<std::uint32_t>(generator() & (entries - 1));
  for (auto _ : state) benchmark::DoNotOptimize(benchmarks::SumEntries(table, places));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(places.size()));
}
BENCHMARK(LimitRandomReads)->DenseRange(13, 21, 2);

// The three products of a layer of 64 neurons: forward, to the inputs, to the weights.
void ProductForward(benchmark::State& state) {
  const auto a = Uniform(kTile * 64), b = Uniform(64 * 64);
  std::vector<float> c(kTile * 64);
  const MatrixProduct product{a.data(), 64, 1, b.data(), 64, c.data(), 64, kTile, 64, 64};
  for (auto _ : state) {
    Multiply(product, Epilogue::kStoreRelu);
    benchmark::ClobberMemory();
  }
  SetFlops(state, 2.0 * kTile * 64 * 64);
}
BENCHMARK(ProductForward);

void ProductToWeights(benchmark::State& state) {
  const auto a = Uniform(kTile * 64), b = Uniform(kTile * 64);
  std::vector<float> c(64 * 64);
  const MatrixProduct product{a.data(), 1, 64, b.data(), 64, c.data(), 64, 64, kTile, 64};
  for (auto _ : state) {
    Multiply(product, Epilogue::kAdd);
    benchmark::ClobberMemory();
  }
  SetFlops(state, 2.0 * kTile * 64 * 64);
}
BENCHMARK(ProductToWeights);

#ifdef NERF_HAVE_LIBXSMM
// The same forward product by libxsmm, compiled for its shape while running; it has no ReLU to do.
void ProductForwardLibxsmm(benchmark::State& state) {
  const auto a = Uniform(kTile * 64), b = Uniform(64 * 64);
  std::vector<float> c(kTile * 64);
  // libxsmm counts in columns: its C' = B' A' is our C = A B.
  const int m = 64, n = kTile, k = 64;
  const float one = 1, zero = 0;
  const libxsmm_smmfunction multiply =
      libxsmm_smmdispatch(m, n, k, nullptr, nullptr, nullptr, &one, &zero, nullptr, nullptr);
  if (multiply == nullptr) {
    state.SkipWithError("libxsmm has no kernel for this machine");
    return;
  }
  for (auto _ : state) {
    multiply(b.data(), a.data(), c.data());
    benchmark::ClobberMemory();
  }
  SetFlops(state, 2.0 * kTile * 64 * 64);
}
BENCHMARK(ProductForwardLibxsmm);
#endif

// The networks of the default field, whole.
struct Network {
  explicit Network(std::vector<int> widths, Precision precision)
      : mlp(widths, precision), gradients(mlp.GradientSize()) {
    std::vector<std::vector<float>> weights;
    std::vector<const float*> pointers;
    for (int l = 0; l < mlp.Layers(); ++l) {
      weights.push_back(Uniform(widths[l] * widths[l + 1], -0.1f, 0.1f));
      flops += 2.0 * kTile * widths[l] * widths[l + 1];
    }
    for (const auto& layer : weights) pointers.push_back(layer.data());
    mlp.Load(pointers);
    for (const int width : widths) storage.push_back(Uniform(kTile * PaddedWidth(width)));
    for (auto& layer : storage) rows.push_back(layer.data());
  }
  TileMlp mlp;
  double flops = 0;  // forward
  std::vector<std::vector<float>> storage;
  std::vector<float*> rows;
  std::vector<float> gradients;
};

// The density network and the colour network, in float and in bfloat16.
Network NetworkOf(const benchmark::State& state) {
  const Precision precision = state.range(1) == 0 ? Precision::kFloat : Precision::kBfloat16;
  return state.range(0) == 0 ? Network({32, 64, 16}, precision)
                             : Network({31, 64, 64, 3}, precision);
}
void EveryNetwork(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"color", "bfloat16"})->ArgsProduct({{0, 1}, {0, 1}});
}

void NetworkForward(benchmark::State& state) {
  Network network = NetworkOf(state);
  for (auto _ : state) network.mlp.Forward(kTile, network.rows);
  SetFlops(state, network.flops);
  state.SetItemsProcessed(state.iterations() * kTile);
}
BENCHMARK(NetworkForward)->Apply(EveryNetwork);

void NetworkForwardAndBackward(benchmark::State& state) {
  Network network = NetworkOf(state);
  for (auto _ : state) {
    network.mlp.Forward(kTile, network.rows);
    network.mlp.Backward(kTile, network.rows, network.gradients);
  }
  SetFlops(state, 3 * network.flops);
  state.SetItemsProcessed(state.iterations() * kTile);
}
BENCHMARK(NetworkForwardAndBackward)->Apply(EveryNetwork);

// 8 levels of 4 features, by the table's size as a power of two; samples along straight rays.
struct Encoding {
  explicit Encoding(std::int64_t log2_table_size) {
    HashGridOptions options;
    options.log2_table_size = static_cast<int>(log2_table_size);
    layout = MakeHashGridLayout(options);
    table = Uniform(layout.entries * layout.features, -0.1f, 0.1f);
    level_weights.assign(layout.levels.size(), 1.0f);
    constexpr int kRay = 32;
    const auto ends = Uniform(6 * kSamples / kRay);
    for (std::int64_t i = 0; i < kSamples; ++i) {
      const float along = static_cast<float>(i % kRay) / kRay;
      const float* const ray = &ends[6 * (i / kRay)];
      for (int axis = 0; axis < 3; ++axis) {
        positions.push_back(ray[axis] + 0.25f * along * (ray[3 + axis] - ray[axis]));
      }
    }
    encoded.assign(kSamples * layout.OutputSize(), 0.01f);
  }
  static constexpr std::int64_t kSamples = 16384;
  HashGridLayout layout;
  std::vector<float> table, level_weights, positions, encoded;
};

void HashEncode(benchmark::State& state) {
  Encoding e(state.range(0));
  const int row = e.layout.OutputSize();
  for (auto _ : state) {
    for (std::int64_t i = 0; i < Encoding::kSamples; i += kTile) {
      HashEncodeTile(e.layout, e.table.data(), &e.positions[3 * i], kTile, e.level_weights,
                     e.encoded.data(), row);
    }
  }
  state.SetItemsProcessed(state.iterations() * Encoding::kSamples);
}
BENCHMARK(HashEncode)->DenseRange(13, 19, 2);

void HashScatter(benchmark::State& state) {
  Encoding e(state.range(0));
  for (auto _ : state) {
    for (int l = 0; l < static_cast<int>(e.layout.levels.size()); ++l) {
      HashScatterLevel(e.layout, l, 1.0f, e.positions.data(), e.encoded.data(),
                       e.layout.OutputSize(), Encoding::kSamples, e.table.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * Encoding::kSamples);
}
BENCHMARK(HashScatter)->DenseRange(13, 19, 2);

// Rays of 32 samples, forward and backward.
void Composite(benchmark::State& state) {
  constexpr std::int64_t kRays = 64, kSamples = 32 * kRays;
  std::vector<std::int64_t> ray_begin;
  for (std::int64_t r = 0; r <= kRays; ++r) ray_begin.push_back(32 * r);
  const auto sigma = Uniform(kSamples), radiance = Uniform(3 * kSamples),
             background = Uniform(3 * kRays);
  const std::vector<float> dt(kSamples, 0.1f), t(kSamples, 1.0f);
  std::vector<float> rgb(3 * kRays), opacity(kRays), depth(kRays), dL_dsigma(kSamples),
      dL_dradiance(3 * kSamples), dL_dbackground(3 * kRays);
  const RaySegments<float> in{ray_begin, sigma, dt, t, radiance, background};
  for (auto _ : state) {
    CompositeForward<float>(in, {rgb, opacity, depth}, 0, kRays);
    CompositeBackward<float>(in, {rgb, opacity, depth}, {dL_dsigma, dL_dradiance, dL_dbackground},
                             0, kRays);
  }
  state.SetItemsProcessed(state.iterations() * kSamples);
}
BENCHMARK(Composite);

// A table of 2^17 entries of which one in `range` has a gradient.
void SparseAdam(benchmark::State& state) {
  constexpr std::size_t kEntries = 1 << 17;
  AdamCoefficients adam;
  adam.learning_rate = 0.01f;
  const auto corrections = BiasCorrections(adam);
  std::vector<float> p(4 * kEntries), g(4 * kEntries), m(4 * kEntries), v(4 * kEntries);
  std::vector<std::int32_t> steps(kEntries);
  for (auto _ : state) {
    for (std::size_t i = 0; i < g.size(); i += 4 * state.range(0)) g[i] = 0.1f;
    benchmark::DoNotOptimize(SparseAdamStep(adam, 4, corrections, p, g, m, v, steps));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kEntries));
}
BENCHMARK(SparseAdam)->Arg(1)->Arg(8)->Arg(64);

// All descriptors of two photographs with each other, once, for both directions.
void MatchDescriptors(benchmark::State& state) {
  constexpr std::size_t kFeatures = 2048;
  std::mt19937 generator(1);
  std::vector<std::uint8_t> a(kFeatures * kDescriptorSize), b(a.size());
  for (std::uint8_t& number : a) number = static_cast<std::uint8_t>(generator());
  for (std::uint8_t& number : b) number = static_cast<std::uint8_t>(generator());
  std::vector<NearestTwo> of_a(kFeatures), of_b(kFeatures);
  for (auto _ : state) {
    FindNearestTwo(a, b, of_a, of_b);
    benchmark::ClobberMemory();
  }
  SetFlops(state, 2.0 * kFeatures * kFeatures * kDescriptorSize);
}
BENCHMARK(MatchDescriptors);

}  // namespace
}  // namespace nerf::kernels
