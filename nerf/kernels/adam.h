#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace nerf::kernels {

struct AdamCoefficients {
  float learning_rate = 0;
  float beta1 = 0.9f;
  float beta2 = 0.99f;
  float epsilon = 1e-15f;
  float weight_decay = 0;  // L2 penalty, added to the gradient
};

// The bias correction of moments that started at 0, after a number of steps, at least 1.
struct AdamBiasCorrection {
  float first = 1;        // 1 / (1 - beta1^steps)
  float root_second = 1;  // 1 / sqrt(1 - beta2^steps), for the square root of the second moment
};
AdamBiasCorrection BiasCorrection(const AdamCoefficients& adam, std::int64_t steps);

// The corrections by number of steps, [0] being unused, up to the number from which they are 1.
std::vector<AdamBiasCorrection> BiasCorrections(const AdamCoefficients& adam);

// One step of Adam in a single pass over memory. Source: Kingma and Ba 2015, algorithm 1.
//   parameter, first_moment, second_moment  updated
//   gradient  set to 0 for the next step
//   returns   whether all gradients and new parameters are finite; if not, parameters are invalid
bool AdamStep(const AdamCoefficients& adam, const AdamBiasCorrection& correction,
              std::span<float> parameter, std::span<float> gradient, std::span<float> first_moment,
              std::span<float> second_moment);

// The same for a table of entries of which a step updates few: an entry whose gradient is 0 in
// every feature is not changed, nor are its moments. Each entry counts its own steps, since with
// the count of the whole table the first moments of an entry updated late would not be
// bias-corrected.
//   features     floats per entry: 1, 2, 4 or 8
//   corrections  BiasCorrections(adam)
//   steps        [entries] updated
bool SparseAdamStep(const AdamCoefficients& adam, int features,
                    std::span<const AdamBiasCorrection> corrections, std::span<float> parameter,
                    std::span<float> gradient, std::span<float> first_moment,
                    std::span<float> second_moment, std::span<std::int32_t> steps);

}  // namespace nerf::kernels
