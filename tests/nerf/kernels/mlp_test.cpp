#include "nerf/kernels/mlp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "nerf/kernels/matrix_product.h"
#include "nerf/reference/mlp.h"
#include "tests/support/simd_levels.h"

namespace nerf::kernels {
namespace {

class TileMlps : public test::EverySimdLevel {
 protected:
  void Make(const std::vector<int>& widths, std::int64_t samples) {
    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    widths_ = widths;
    samples_ = samples;
    weights_.clear();
    for (std::size_t l = 0; l + 1 < widths.size(); ++l) {
      weights_.emplace_back(widths[l] * widths[l + 1]);
      for (double& w : weights_.back()) w = static_cast<float>(normal(generator));
    }
    inputs_.assign(samples * widths[0], 0.0);
    for (double& x : inputs_) x = static_cast<float>(normal(generator));
    direction_.assign(samples * widths.back(), 0.0);
    for (double& d : direction_) d = static_cast<float>(normal(generator));
  }

  std::vector<double> InputsOf(std::int64_t sample) const {
    const int width = widths_[0];
    return {inputs_.begin() + sample * width, inputs_.begin() + (sample + 1) * width};
  }

  // sum over samples of direction . outputs, the loss whose gradients Backward takes.
  double Loss() const {
    double loss = 0;
    for (std::int64_t s = 0; s < samples_; ++s) {
      const auto out = reference::Mlp(widths_, weights_, InputsOf(s));
      for (int o = 0; o < widths_.back(); ++o) loss += direction_[s * widths_.back() + o] * out[o];
    }
    return loss;
  }

  // Central differences are exact except where a ReLU changes its sign between the two points.
  double Numeric(double& at) const {
    const double old = at, h = 1e-6;
    at = old + h;
    const double above = Loss();
    at = old - h;
    const double below = Loss();
    at = old;
    return (above - below) / (2 * h);
  }

  std::vector<int> widths_;
  std::int64_t samples_ = 0;
  reference::Weights weights_;
  std::vector<double> inputs_, direction_;
};

TEST_P(TileMlps, ForwardAndBackwardMatchPlainLoopsAndCentralDifferences) {
  for (const std::vector<int>& widths :
       {std::vector<int>{5, 3}, {32, 64, 16}, {7, 9, 20, 3}, {31, 16, 16, 16, 3}}) {
    constexpr std::int64_t kSamples = 13;
    Make(widths, kSamples);
    TileMlp mlp(widths);
    std::vector<std::vector<float>> given;
    std::vector<const float*> pointers;
    for (const auto& layer : weights_) given.emplace_back(layer.begin(), layer.end());
    for (const auto& layer : given) pointers.push_back(layer.data());
    mlp.Load(pointers);

    std::vector<std::vector<float>> storage;
    std::vector<float*> rows;
    for (const int width : widths) storage.emplace_back(kSamples * PaddedWidth(width), 0.0f);
    for (auto& layer : storage) rows.push_back(layer.data());
    const auto at = [&](std::size_t l, std::int64_t s, int i) -> float& {
      return rows[l][s * PaddedWidth(widths[l]) + i];
    };
    for (std::int64_t s = 0; s < kSamples; ++s) {
      for (int i = 0; i < widths[0]; ++i) {
        at(0, s, i) = static_cast<float>(inputs_[s * widths[0] + i]);
      }
    }
    mlp.Forward(kSamples, rows);
    const std::size_t last = widths.size() - 1;
    for (std::int64_t s = 0; s < kSamples; ++s) {
      const auto expected = reference::Mlp(widths, weights_, InputsOf(s));
      for (int o = 0; o < widths.back(); ++o) {
        EXPECT_NEAR(at(last, s, o), expected[o], 1e-4 * (1 + std::fabs(expected[o])));
        at(last, s, o) = static_cast<float>(direction_[s * widths.back() + o]);
      }
    }

    std::vector<float> gradients(mlp.GradientSize(), 0.0f);
    mlp.Backward(kSamples, rows, gradients);
    for (std::int64_t s = 0; s < kSamples; s += 5) {
      for (int i = 0; i < widths[0]; i += 3) {
        const double numeric = Numeric(inputs_[s * widths[0] + i]);
        EXPECT_NEAR(at(0, s, i), numeric, 1e-3 * (1 + std::fabs(numeric)));
      }
    }
    std::vector<std::vector<float>> dL_dw;
    std::vector<float*> dL_dw_rows;
    for (const auto& layer : given) dL_dw.emplace_back(layer.size(), 1.0f);  // added to
    for (auto& layer : dL_dw) dL_dw_rows.push_back(layer.data());
    mlp.AddGradients(gradients, dL_dw_rows);
    for (std::size_t l = 0; l < weights_.size(); ++l) {
      for (std::size_t i = 0; i < weights_[l].size(); i += 1 + weights_[l].size() / 17) {
        const double numeric = Numeric(weights_[l][i]);
        EXPECT_NEAR(dL_dw[l][i] - 1.0f, numeric, 1e-3 * (1 + std::fabs(numeric)));
      }
    }
  }
}

// The error of training in bfloat16: three layers of rounding, and in the backward pass also ReLUs
// whose sign the rounding changed.
TEST_P(TileMlps, Bfloat16StaysCloseToFloat) {
  const std::vector<int> widths = {31, 64, 64, 3};
  constexpr std::int64_t kSamples = 37;
  Make(widths, kSamples);
  std::vector<std::vector<float>> given;
  std::vector<const float*> pointers;
  for (const auto& layer : weights_) given.emplace_back(layer.begin(), layer.end());
  for (const auto& layer : given) pointers.push_back(layer.data());
  const auto run = [&](Precision precision) {
    TileMlp mlp(widths, precision);
    mlp.Load(pointers);
    std::vector<std::vector<float>> storage;
    std::vector<float*> rows;
    for (const int width : widths) storage.emplace_back(kSamples * PaddedWidth(width), 0.0f);
    for (auto& layer : storage) rows.push_back(layer.data());
    for (std::int64_t s = 0; s < kSamples; ++s) {
      for (int i = 0; i < widths[0]; ++i) {
        rows[0][s * PaddedWidth(widths[0]) + i] = static_cast<float>(inputs_[s * widths[0] + i]);
      }
    }
    mlp.Forward(kSamples, rows);
    std::vector<std::vector<float>> results = {storage.back()};
    for (std::int64_t s = 0; s < kSamples; ++s) {
      for (int o = 0; o < widths.back(); ++o) {
        rows[3][s * PaddedWidth(3) + o] = static_cast<float>(direction_[s * widths.back() + o]);
      }
    }
    std::vector<float> gradients(mlp.GradientSize(), 0.0f);
    mlp.Backward(kSamples, rows, gradients);
    results.push_back(storage.front());
    results.push_back(gradients);
    return results;
  };
  const auto exact = run(Precision::kFloat), rounded = run(Precision::kBfloat16);
  for (std::size_t k = 0; k < exact.size(); ++k) {
    double error = 0, size = 0;
    for (std::size_t i = 0; i < exact[k].size(); ++i) {
      const double difference = static_cast<double>(rounded[k][i] - exact[k][i]);
      error += difference * difference;
      size += static_cast<double>(exact[k][i]) * static_cast<double>(exact[k][i]);
    }
    EXPECT_LT(std::sqrt(error / size), k == 0 ? 0.02 : 0.08) << k;
    EXPECT_GT(error, 0) << k;  // it did round
  }
}

NERF_FOR_EVERY_SIMD_LEVEL(TileMlps);

}  // namespace
}  // namespace nerf::kernels
