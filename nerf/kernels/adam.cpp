#include "nerf/kernels/adam.h"

#include <cmath>

#include "nerf/kernels/flush_denormals.h"

namespace nerf::kernels {

bool AdamStep(const AdamCoefficients& adam, std::span<float> parameter,
              std::span<const float> gradient, std::span<float> first_moment,
              std::span<float> second_moment) {
  const FlushDenormals flush;
  const float step_size = adam.learning_rate / adam.bias_correction1;
  const float scale2 = 1.0f / std::sqrt(adam.bias_correction2);
  const float beta1 = adam.beta1, beta2 = adam.beta2;
  const float epsilon = adam.epsilon, weight_decay = adam.weight_decay;
  float* const p = parameter.data();
  const float* const g = gradient.data();
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
  }
  return check == 0.0f;
}

}  // namespace nerf::kernels
