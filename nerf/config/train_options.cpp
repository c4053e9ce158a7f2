#include "nerf/config/train_options.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/base/input_error.h"

namespace nerf {

void LossOptions::Check() const {
  if (kind != "huber" && kind != "mse") {
    throw InputError("config: loss.kind is \"{}\"; use \"huber\" or \"mse\"", kind);
  }
  if (!(huber_delta > 0)) throw InputError("config: loss.huber_delta must be above 0");
}

void OptimizerOptions::Check() const {
  if (!(learning_rate > 0 && learning_rate <= 1e6)) {
    throw InputError("config: optimizer.learning_rate is {}; use a value above 0, at most 1e6",
                     learning_rate);
  }
  if (!(beta1 >= 0 && beta1 <= 0.9999 && beta2 >= 0 && beta2 <= 0.9999)) {
    throw InputError("config: optimizer.beta1 {} and beta2 {} must be in [0, 0.9999]", beta1,
                     beta2);
  }
  if (!(epsilon > 0)) throw InputError("config: optimizer.epsilon must be above 0");
  if (!(weight_decay >= 0)) {
    throw InputError("config: optimizer.weight_decay must not be negative");
  }
}

void GradientScalingOptions::Check() const {
  if (!(full_distance >= 0 && std::isfinite(full_distance))) {
    throw InputError("config: gradient_scaling.full_distance is {}; use 0 or more", full_distance);
  }
}

void ScheduleOptions::Check() const {
  if (warmup_steps < 0) throw InputError("config: schedule.warmup_steps must not be negative");
  if (!(final_factor > 0 && final_factor <= 1)) {
    throw InputError("config: schedule.final_factor is {}; use a value above 0, at most 1",
                     final_factor);
  }
}

double LearningRateFactor(const ScheduleOptions& schedule, std::int64_t step, double progress) {
  const double rise = schedule.warmup_steps > 0
                          ? std::min(1.0, static_cast<double>(step + 1) / schedule.warmup_steps)
                          : 1.0;
  const double fall = 0.5 * (1.0 + std::cos(std::numbers::pi * std::clamp(progress, 0.0, 1.0)));
  return rise * (schedule.final_factor + (1.0 - schedule.final_factor) * fall);
}

void TrainOptions::Check() const {
  if (engine != "fused" && engine != "libtorch") {
    throw InputError("config: train.engine is \"{}\"; use \"fused\" or \"libtorch\"", engine);
  }
  if (precision != "float" && precision != "bfloat16") {
    throw InputError("config: train.precision is \"{}\"; use \"float\" or \"bfloat16\"", precision);
  }
  if (precision == "bfloat16" && engine == "libtorch") {
    throw InputError(
        "config: train.precision \"bfloat16\" is of the fused engine; leave train.engine=libtorch "
        "away");
  }
  if (steps < 1) throw InputError("config: train.steps is {}; use 1 or more", steps);
  constexpr double kMonth = 30 * 24 * 3600;
  if (!(time_budget == 0 || (time_budget >= 1 && time_budget <= kMonth))) {
    throw InputError("config: train.time_budget is {} seconds; use 0 (none) or 1 to {:.0f}",
                     time_budget, kMonth);
  }
  if (!(target_psnr >= 0 && target_psnr <= 100)) {
    throw InputError("config: train.target_psnr is {} dB; use 0 (none) to 100", target_psnr);
  }
  if (samples_per_batch < 1 || samples_per_batch > (1 << 24)) {
    throw InputError("config: train.samples_per_batch is {}; use 1 to {}", samples_per_batch,
                     1 << 24);
  }
  if (max_rays_per_batch < 1 || max_rays_per_batch > (1 << 22)) {
    throw InputError("config: train.max_rays_per_batch is {}; use 1 to {}", max_rays_per_batch,
                     1 << 22);
  }
  if (!(error_driven_share >= 0 && error_driven_share <= 1)) {
    throw InputError("config: train.error_driven_share is {}; use 0 to 1", error_driven_share);
  }
  if (checkpoint_every < 1 || validate_every < 1) {
    throw InputError("config: train.checkpoint_every and validate_every must be at least 1");
  }
}

}  // namespace nerf
