// Kernels on several threads at once, as the engines run them: the same bits as on one, and nothing
// for the thread sanitizer to find.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nerf/base/parallel.h"
#include "nerf/kernels/adam.h"
#include "nerf/kernels/hash_encoding_tile.h"
#include "nerf/kernels/mlp.h"
#include "nerf/kernels/volume_rendering.h"

namespace nerf::kernels {
namespace {

class KernelsOnThreads : public testing::Test {
 protected:
  ~KernelsOnThreads() override { SetNumThreads(AvailableCores()); }

  // What `run` leaves on one thread and on four.
  template <class Run>
  static void ExpectTheSame(const Run& run) {
    SetNumThreads(1);
    const std::vector<float> one = run();
    SetNumThreads(4);
    for (int repeat = 0; repeat < 3; ++repeat) EXPECT_EQ(run(), one);
  }

  static std::vector<float> Waves(std::size_t count, float low, float high) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float wave = 0.5f + 0.5f * std::sin(1.3f * static_cast<float>(i * i % 1009));
      values[i] = low + (high - low) * wave;
    }
    return values;
  }
};

constexpr std::int64_t kRays = 256, kSamples = 16 * kRays;

TEST_F(KernelsOnThreads, CompositeEachRayIndependently) {
  std::vector<std::int64_t> begin(kRays + 1);
  for (std::int64_t r = 0; r <= kRays; ++r) begin[r] = 16 * r;
  const auto sigma = Waves(kSamples, 0, 5), dt = Waves(kSamples, 0, 0.2f),
             t = Waves(kSamples, 1, 2), radiance = Waves(3 * kSamples, 0, 1),
             background = Waves(3 * kRays, 0, 1), ones = Waves(3 * kRays, 1, 1);
  ExpectTheSame([&] {
    std::vector<float> rgb(3 * kRays), opacity(kRays), depth(kRays), of_sigma(kSamples),
        of_radiance(3 * kSamples), of_background(3 * kRays);
    const RaySegments<float> in = {begin, sigma, dt, t, radiance, background};
    ParallelFor(kRays, 1, [&](std::int64_t first, std::int64_t last) {
      CompositeForward<float>(in, {rgb, opacity, depth}, first, last);
      CompositeBackward<float>(in, {ones, opacity, depth}, {of_sigma, of_radiance, of_background},
                               first, last);
    });
    rgb.insert(rgb.end(), of_sigma.begin(), of_sigma.end());
    return rgb;
  });
}

TEST_F(KernelsOnThreads, ScatterEachLevelIndependently) {
  const HashGridLayout layout = MakeHashGridLayout({6, 4, 10, 4, 128});
  const auto positions = Waves(3 * kSamples, 0, 1);
  const auto table = Waves(layout.entries * 4, -1, 1);
  const std::vector<float> all(layout.levels.size(), 1.0f);
  const int row = layout.OutputSize();
  ExpectTheSame([&] {
    std::vector<float> encoded(kSamples * row), dL_dtable(table.size(), 0.0f);
    ParallelFor(kSamples, 64, [&](std::int64_t first, std::int64_t last) {
      HashEncodeTile(layout, table.data(), &positions[3 * first], last - first, all,
                     &encoded[first * row], row);
    });
    ParallelForEach(static_cast<std::int64_t>(layout.levels.size()), [&](std::int64_t level) {
      HashScatterLevel(layout, static_cast<int>(level), 1.0f, positions.data(), encoded.data(), row,
                       kSamples, dL_dtable.data());
    });
    return dL_dtable;
  });
}

TEST_F(KernelsOnThreads, NetworksShareOnlyTheirWeights) {
  const std::vector<int> widths = {32, 64, 16};
  const auto first_layer = Waves(32 * 64, -0.3f, 0.3f), second_layer = Waves(64 * 16, -0.3f, 0.3f);
  const std::vector<const float*> weights = {first_layer.data(), second_layer.data()};
  for (const Precision precision : {Precision::kFloat, Precision::kBfloat16}) {
    TileMlp mlp(widths, precision);
    mlp.Load(weights);
    ExpectTheSame([&] {
      std::vector<float> in = Waves(kSamples * 32, -1, 1), hidden(kSamples * 64),
                         out(kSamples * 16);
      constexpr std::int64_t kTile = 64;
      ParallelForEach(kSamples / kTile, [&](std::int64_t tile) {
        const std::int64_t at = tile * kTile;
        const std::vector<float*> rows = {&in[at * 32], &hidden[at * 64], &out[at * 16]};
        std::vector<float> gradients(mlp.GradientSize());
        mlp.Forward(kTile, rows);
        mlp.Backward(kTile, rows, gradients);
      });
      return in;
    });
  }
}

TEST_F(KernelsOnThreads, AdamUpdatesEachParameterIndependently) {
  AdamCoefficients adam;
  adam.learning_rate = 0.01f;
  const auto corrections = BiasCorrections(adam);
  constexpr std::int64_t kEntries = 5000;
  ExpectTheSame([&] {
    std::vector<float> p = Waves(4 * kEntries, -1, 1), g = Waves(4 * kEntries, -1, 1),
                       m(4 * kEntries), v(4 * kEntries);
    std::vector<std::int32_t> steps(kEntries);
    ParallelFor(kEntries, 16, [&](std::int64_t first, std::int64_t last) {
      const auto part = [&](std::vector<float>& values) {
        return std::span(values).subspan(4 * first, 4 * (last - first));
      };
      SparseAdamStep(adam, 4, corrections, part(p), part(g), part(m), part(v),
                     std::span(steps).subspan(first, last - first));
    });
    return p;
  });
}

}  // namespace
}  // namespace nerf::kernels
