// Small networks, in float and in bfloat16, and the step of the optimizer.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "nerf/kernels/adam.h"
#include "nerf/kernels/bfloat16_product.h"
#include "nerf/kernels/mlp.h"
#include "nerf/reference/mlp.h"
#include "nerf/selfcheck/numeric_case.h"

namespace nerf {
namespace {

using kernels::PaddedWidth;
using kernels::Precision;
using kernels::TileMlp;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// A network with random weights and a tile of random inputs.
struct Trial {
  std::vector<int> widths;
  std::int64_t samples = 13;
  std::vector<std::vector<float>> weights;
  std::vector<float> inputs, dL_dout;  // [samples, width]

  explicit Trial(std::vector<int> layer_widths) : widths(std::move(layer_widths)) {
    std::mt19937 generator(7);
    std::normal_distribution<float> normal;
    for (std::size_t l = 0; l + 1 < widths.size(); ++l) {
      weights.emplace_back(widths[l] * widths[l + 1]);
      for (float& w : weights.back()) w = normal(generator);
    }
    inputs.resize(samples * widths.front());
    for (float& x : inputs) x = normal(generator);
    dL_dout.resize(samples * widths.back());
    for (float& g : dL_dout) g = normal(generator);
  }

  struct Result {
    std::vector<float> out, dL_din;
    std::vector<std::vector<float>> dL_dw;  // per layer: [outputs, inputs]
  };
  Result Run(Precision precision) const {
    TileMlp mlp(widths, precision);
    std::vector<const float*> pointers;
    for (const auto& layer : weights) pointers.push_back(layer.data());
    mlp.Load(pointers);
    std::vector<std::vector<float>> storage;
    std::vector<float*> rows;
    for (const int width : widths) storage.emplace_back(samples * PaddedWidth(width), 0.0f);
    for (auto& layer : storage) rows.push_back(layer.data());
    Put(inputs, widths.front(), rows.front());
    mlp.Forward(samples, rows);
    Result result;
    result.out = Take(rows.back(), widths.back());
    std::fill(storage.back().begin(), storage.back().end(), 0.0f);
    Put(dL_dout, widths.back(), rows.back());
    std::vector<float> gradients(mlp.GradientSize(), 0.0f);
    mlp.Backward(samples, rows, gradients);
    std::vector<float*> of_layer;
    for (const auto& layer : weights) result.dL_dw.emplace_back(layer.size(), 0.0f);
    for (auto& layer : result.dL_dw) of_layer.push_back(layer.data());
    mlp.AddGradients(gradients, of_layer);
    result.dL_din = Take(rows.front(), widths.front());
    return result;
  }

 private:
  void Put(const std::vector<float>& values, int width, float* row) const {
    for (std::int64_t s = 0; s < samples; ++s) {
      std::copy_n(&values[s * width], width, row + s * PaddedWidth(width));
    }
  }
  std::vector<float> Take(const float* row, int width) const {
    std::vector<float> values(samples * width);
    for (std::int64_t s = 0; s < samples; ++s) {
      std::copy_n(row + s * PaddedWidth(width), width, &values[s * width]);
    }
    return values;
  }
};

const std::vector<std::vector<int>> kWidths = {
    {5, 3}, {32, 64, 16}, {7, 9, 20, 3}, {31, 16, 16, 16, 3}};

double LargestOf(const std::vector<float>& values) {
  double largest = 0;
  for (const float v : values) largest = std::max(largest, std::fabs(static_cast<double>(v)));
  return largest;
}

double NetworksMatchPlainLoops() {
  WorstError worst;
  for (const std::vector<int>& widths : kWidths) {
    const Trial trial(widths);
    reference::Weights exact;
    for (const auto& layer : trial.weights) exact.emplace_back(layer.begin(), layer.end());
    const auto out = trial.Run(Precision::kFloat).out;
    for (std::int64_t s = 0; s < trial.samples; ++s) {
      const auto* const x = &trial.inputs[s * widths.front()];
      const auto truth = reference::Mlp(widths, exact, {x, x + widths.front()});
      for (std::size_t o = 0; o < truth.size(); ++o) {
        worst.AddRelative(out[s * truth.size() + o], truth[o], LargestOf(out));
      }
    }
  }
  return worst.Get();
}

// Central differences of the plain loops, by each input and by one weight in seven.
double NetworkGradientsMatchDifferences() {
  WorstError worst;
  constexpr double kStep = 1e-7;
  for (const std::vector<int>& widths : kWidths) {
    const Trial trial(widths);
    reference::Weights exact;
    for (const auto& layer : trial.weights) exact.emplace_back(layer.begin(), layer.end());
    std::vector<double> inputs(trial.inputs.begin(), trial.inputs.end());
    const auto loss = [&] {
      double sum = 0;
      for (std::int64_t s = 0; s < trial.samples; ++s) {
        const double* const x = &inputs[s * widths.front()];
        const auto out = reference::Mlp(widths, exact, {x, x + widths.front()});
        for (std::size_t o = 0; o < out.size(); ++o) {
          sum += out[o] * static_cast<double>(trial.dL_dout[s * out.size() + o]);
        }
      }
      return sum;
    };
    const auto slope = [&](double& at) {
      const double before = at;
      at = before + kStep;
      const double above = loss();
      at = before - kStep;
      const double below = loss();
      at = before;
      return (above - below) / (2 * kStep);
    };
    const auto found = trial.Run(Precision::kFloat);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      worst.AddRelative(found.dL_din[i], slope(inputs[i]), LargestOf(found.dL_din));
    }
    for (std::size_t l = 0; l < exact.size(); ++l) {
      for (std::size_t i = 0; i < exact[l].size(); i += 7) {
        worst.AddRelative(found.dL_dw[l][i], slope(exact[l][i]), LargestOf(found.dL_dw[l]));
      }
    }
  }
  return worst.Get();
}

// A float is rounded to the nearest bfloat16. Its eight bits allow an error of at most 2^-8;
// cutting the float off would give up to 2^-7.
double Bfloat16IsRoundedToTheNearest() {
  WorstError worst;
  std::vector<float> values(64);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto at = static_cast<float>(i);
    values[i] = (i % 2 == 0 ? 1 : -1) * std::exp(at - 30) * (1 + at / 64 + 0.003f);
  }
  std::vector<std::uint32_t> pairs(32);
  kernels::PairColumns(values.data(), 64, 1, 64, pairs.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t bits = i % 2 == 0 ? pairs[i / 2] << 16 : pairs[i / 2] & 0xffff0000u;
    worst.AddRelative(std::bit_cast<float>(bits), values[i]);
  }
  return worst.Get();
}

double NetworksInBfloat16StayCloseToFloat() {
  WorstError worst;
  for (const std::vector<int>& widths : kWidths) {
    const Trial trial(widths);
    const auto exact = trial.Run(Precision::kFloat), rounded = trial.Run(Precision::kBfloat16);
    for (std::size_t i = 0; i < exact.out.size(); ++i) {
      worst.Add(static_cast<double>(rounded.out[i] - exact.out[i]) / LargestOf(exact.out));
    }
  }
  return worst.Get();
}

double NetworksPropagateNaN() {
  WorstError worst;
  for (const Precision precision : {Precision::kFloat, Precision::kBfloat16}) {
    Trial trial({32, 64, 16});
    trial.inputs[5] = kNaN;  // of the first sample
    const auto out = trial.Run(precision).out;
    for (int o = 0; o < 16; ++o) worst.Require(std::isnan(out[o]));
    for (std::size_t i = 16; i < out.size(); ++i) worst.RequireFinite(out[i]);
  }
  return worst.Get();
}

// Steps of Adam by the published algorithm in double.
double AdamFollowsThePublishedAlgorithm() {
  WorstError worst;
  kernels::AdamCoefficients adam;
  adam.learning_rate = 1e-2f;
  for (const float size : {1e-20f, 1e-6f, 1.0f, 1e6f}) {
    constexpr int kCount = 19;
    std::vector<float> p(kCount, 0.5f), g(kCount), m(kCount, 0.0f), v(kCount, 0.0f);
    std::vector<double> exact_p(kCount, 0.5), exact_m(kCount, 0.0), exact_v(kCount, 0.0);
    const double b1 = static_cast<double>(adam.beta1), b2 = static_cast<double>(adam.beta2);
    const double rate = static_cast<double>(adam.learning_rate);
    for (int step = 1; step <= 20; ++step) {
      for (int i = 0; i < kCount; ++i) {
        g[i] = size * std::sin(static_cast<float>(i + 3 * step));
        const double gradient = static_cast<double>(g[i]);
        exact_m[i] = b1 * exact_m[i] + (1 - b1) * gradient;
        exact_v[i] = b2 * exact_v[i] + (1 - b2) * gradient * gradient;
        const double first = exact_m[i] / (1 - std::pow(b1, step));
        const double second = exact_v[i] / (1 - std::pow(b2, step));
        exact_p[i] -= rate * first / (std::sqrt(second) + static_cast<double>(adam.epsilon));
      }
      worst.Require(kernels::AdamStep(adam, kernels::BiasCorrection(adam, step), p, g, m, v));
    }
    for (int i = 0; i < kCount; ++i) worst.AddRelative(p[i], exact_p[i], 0.1L);
  }
  return worst.Get();
}

double AdamReportsEveryNonFiniteGradient() {
  WorstError worst;
  const kernels::AdamCoefficients adam;
  for (const float bad : {kNaN, std::numeric_limits<float>::infinity()}) {
    for (std::size_t at = 0; at < 19; ++at) {
      std::vector<float> p(19, 0.5f), g(19, 0.1f), m(19, 0.0f), v(19, 0.0f);
      g[at] = bad;
      worst.Require(!kernels::AdamStep(adam, kernels::BiasCorrection(adam, 1), p, g, m, v));
    }
  }
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> NetworkCases() {
  return {
      {"NetworksMatchPlainLoops", "output, parts of the largest", Within(1e-6, 2.9e-7), true,
       NetworksMatchPlainLoops},
      {"NetworkGradientsMatchDifferences", "gradient, parts of the largest", Within(1e-6, 1.6e-7),
       true, NetworkGradientsMatchDifferences},
      {"NetworksInBfloat16StayCloseToFloat", "output, parts of the largest",
       Within(2e-2, 6.8e-3, 0x1p-8), true, NetworksInBfloat16StayCloseToFloat},
      {"Bfloat16IsRoundedToTheNearest", "relative", Within(0x1p-8, 3.4e-3, 0x1p-8), true,
       Bfloat16IsRoundedToTheNearest},
      {"NetworksPropagateNaN", "propagated or not", kExact, true, NetworksPropagateNaN},
      {"AdamFollowsThePublishedAlgorithm", "parameter, relative", Within(2e-6, 2.6e-7), true,
       AdamFollowsThePublishedAlgorithm},
      {"AdamReportsEveryNonFiniteGradient", "reported or not", kExact, true,
       AdamReportsEveryNonFiniteGradient},
  };
}

}  // namespace nerf
