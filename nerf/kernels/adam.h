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

// What moments that started at 0 are multiplied by after a number of steps, at least 1.
struct AdamBiasCorrection {
  float first = 1;        // 1 / (1 - beta1^steps)
  float root_second = 1;  // 1 / sqrt(1 - beta2^steps), of the second moment's root
};
AdamBiasCorrection BiasCorrection(const AdamCoefficients& adam, std::int64_t steps);

// The corrections after 1 (in the second place), 2, 3, ... steps, until they have become 1 and
// stay.
std::vector<AdamBiasCorrection> BiasCorrections(const AdamCoefficients& adam);

// One step of Adam in a single pass over memory. Source: Kingma and Ba 2015, algorithm 1.
//   parameter, first_moment, second_moment  updated
//   gradient  set to 0 for the next step
//   returns   whether every gradient and new parameter is finite; where not, parameters are spoilt
bool AdamStep(const AdamCoefficients& adam, const AdamBiasCorrection& correction,
              std::span<float> parameter, std::span<float> gradient, std::span<float> first_moment,
              std::span<float> second_moment);

// The same for a table of entries of which a step touches few: an entry whose gradient is 0 in
// every feature stays as it is, moments too. Each entry counts its own steps, for with the count of
// the whole table an entry that is touched late would take its first moments for settled ones.
//   features     floats of an entry: 1, 2, 4 or 8
//   corrections  BiasCorrections(adam)
//   steps        [entries] updated
bool SparseAdamStep(const AdamCoefficients& adam, int features,
                    std::span<const AdamBiasCorrection> corrections, std::span<float> parameter,
                    std::span<float> gradient, std::span<float> first_moment,
                    std::span<float> second_moment, std::span<std::int32_t> steps);

}  // namespace nerf::kernels
