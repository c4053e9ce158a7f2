#pragma once

#include <span>

namespace nerf::kernels {

struct AdamCoefficients {
  float learning_rate = 0;
  float beta1 = 0.9f;
  float beta2 = 0.99f;
  float epsilon = 1e-15f;
  float weight_decay = 0;      // L2 penalty, added to the gradient
  float bias_correction1 = 1;  // 1 - beta1^step
  float bias_correction2 = 1;  // 1 - beta2^step
};

// One step of Adam in a single pass over memory. Source: Kingma and Ba 2015, algorithm 1.
//   parameter, first_moment, second_moment  updated
//   returns  whether every gradient was finite; where not, the parameters are spoilt
bool AdamStep(const AdamCoefficients& adam, std::span<float> parameter,
              std::span<const float> gradient, std::span<float> first_moment,
              std::span<float> second_moment);

}  // namespace nerf::kernels
