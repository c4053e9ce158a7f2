#include "nerf/kernels/adam.h"

#include <algorithm>
#include <cmath>

#include "nerf/kernels/flush_denormals.h"

namespace nerf::kernels {
namespace {

template <int kFeatures>
bool SparseStep(const AdamCoefficients& adam, std::span<const AdamBiasCorrection> corrections,
                float* p, float* g, float* m, float* v, std::span<std::int32_t> steps) {
  const auto settled = static_cast<std::int32_t>(corrections.size()) - 1;
  const float beta1 = adam.beta1, beta2 = adam.beta2, epsilon = adam.epsilon;
  float check = 0;
  for (std::size_t entry = 0; entry < steps.size();
       ++entry, p += kFeatures, g += kFeatures, m += kFeatures, v += kFeatures) {
    bool touched = false;
    for (int f = 0; f < kFeatures; ++f) touched |= g[f] != 0;
    if (!touched) continue;
    // Counted no further than to where the correction is 1.
    steps[entry] = std::min(steps[entry] + 1, settled);
    const AdamBiasCorrection correction = corrections[steps[entry]];
    const float step_size = adam.learning_rate / correction.first;
    const float scale2 = 1.0f / std::sqrt(correction.second);
    for (int f = 0; f < kFeatures; ++f) {
      const float total = g[f] + adam.weight_decay * p[f];
      check += total * 0.0f;
      m[f] = beta1 * m[f] + (1 - beta1) * total;
      v[f] = beta2 * v[f] + (1 - beta2) * total * total;
      p[f] -= step_size * m[f] / (std::sqrt(v[f]) * scale2 + epsilon);
      check += p[f] * 0.0f;
      g[f] = 0;
    }
  }
  return check == 0.0f;
}

}  // namespace

AdamBiasCorrection BiasCorrection(const AdamCoefficients& adam, std::int64_t steps) {
  const auto of = [&](float beta) {
    return static_cast<float>(1.0 - std::pow(static_cast<double>(beta), steps));
  };
  return {of(adam.beta1), of(adam.beta2)};
}

std::vector<AdamBiasCorrection> BiasCorrections(const AdamCoefficients& adam) {
  std::vector<AdamBiasCorrection> corrections = {BiasCorrection(adam, 0)};
  while (corrections.back().first < 1 || corrections.back().second < 1) {
    corrections.push_back(BiasCorrection(adam, static_cast<std::int64_t>(corrections.size())));
  }
  return corrections;
}

bool AdamStep(const AdamCoefficients& adam, const AdamBiasCorrection& correction,
              std::span<float> parameter, std::span<float> gradient, std::span<float> first_moment,
              std::span<float> second_moment) {
  const FlushDenormals flush;
  const float step_size = adam.learning_rate / correction.first;
  const float scale2 = 1.0f / std::sqrt(correction.second);
  const float beta1 = adam.beta1, beta2 = adam.beta2;
  const float epsilon = adam.epsilon, weight_decay = adam.weight_decay;
  float* const p = parameter.data();
  float* const g = gradient.data();
  float* const m = first_moment.data();
  float* const v = second_moment.data();
  // x * 0 is 0 for every finite x and NaN otherwise: one sum tells whether all were finite.
  float check = 0;
#pragma omp simd reduction(+ : check)
  for (std::size_t i = 0; i < parameter.size(); ++i) {
    check += g[i] * 0.0f;
    const float total = g[i] + weight_decay * p[i];
    m[i] = beta1 * m[i] + (1 - beta1) * total;
    v[i] = beta2 * v[i] + (1 - beta2) * total * total;
    p[i] -= step_size * m[i] / (std::sqrt(v[i]) * scale2 + epsilon);
    check += p[i] * 0.0f;
    g[i] = 0;
  }
  return check == 0.0f;
}

bool SparseAdamStep(const AdamCoefficients& adam, int features,
                    std::span<const AdamBiasCorrection> corrections, std::span<float> parameter,
                    std::span<float> gradient, std::span<float> first_moment,
                    std::span<float> second_moment, std::span<std::int32_t> steps) {
  const FlushDenormals flush;
  const auto step = features == 1   ? SparseStep<1>
                    : features == 2 ? SparseStep<2>
                    : features == 4 ? SparseStep<4>
                                    : SparseStep<8>;
  return step(adam, corrections, parameter.data(), gradient.data(), first_moment.data(),
              second_moment.data(), steps);
}

}  // namespace nerf::kernels
