#include "nerf/config/train_options.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/base/input_error.h"

namespace nerf {

double LearningRateFactor(const ScheduleOptions& schedule, std::int64_t step, double progress) {
  const double rise = schedule.warmup_steps > 0
                          ? std::min(1.0, static_cast<double>(step + 1) / schedule.warmup_steps)
                          : 1.0;
  const double fall = 0.5 * (1.0 + std::cos(std::numbers::pi * std::clamp(progress, 0.0, 1.0)));
  return rise * (schedule.final_factor + (1.0 - schedule.final_factor) * fall);
}

void TrainOptions::Check() const {
  if (precision == kernels::Precision::kBfloat16 && engine == EngineKind::kLibTorch) {
    throw InputError(
        "config: train.precision \"bfloat16\" needs the fused engine; remove "
        "train.engine=libtorch");
  }
}

}  // namespace nerf
