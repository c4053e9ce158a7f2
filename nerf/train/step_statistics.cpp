#include "nerf/train/step_statistics.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/peak_memory.h"

namespace nerf {

double PsnrFromMse(double mean_squared_error) { return -10.0 * std::log10(mean_squared_error); }

void StepStatistics::Add(const StepResult& result, std::int64_t rays, const StepSeconds& seconds) {
  loss_ += result.loss;
  squared_error_ += result.squared_error;
  ++steps_;
  rays_ += rays;
  marched_ += result.marched;
  shaded_ += result.shaded;
  seconds_.all += seconds.all;
  seconds_.pixels += seconds.pixels;
  seconds_.occupancy += seconds.occupancy;
  seconds_.optimizer += seconds.optimizer;
  stages_.Add(result.seconds);
}

nlohmann::json StepStatistics::Metrics() const {
  const auto steps = static_cast<double>(steps_);
  const auto rays = static_cast<double>(rays_);
  const double timed = stages_.Sum() + seconds_.pixels + seconds_.occupancy + seconds_.optimizer;
  return {{"loss", loss_ / steps},
          {"train_psnr", PsnrFromMse(squared_error_ / steps)},
          {"rays_per_second", rays / seconds_.all},
          {"samples_per_second", static_cast<double>(shaded_) / seconds_.all},
          {"marched_per_ray", static_cast<double>(marched_) / rays},
          {"samples_per_ray", static_cast<double>(shaded_) / rays},
          {"samples_skipped", 1 - static_cast<double>(shaded_) /
                                      static_cast<double>(std::max<std::int64_t>(1, marched_))},
          {"stage_seconds",
           {{"pixels", seconds_.pixels},
            {"occupancy", seconds_.occupancy},
            {"sampling", stages_.sampling},
            {"encoding", stages_.encoding},
            {"networks", stages_.networks},
            {"compositing", stages_.compositing},
            {"optimizer", seconds_.optimizer},
            {"other", std::max(0.0, seconds_.all - timed)}}},
          {"peak_megabytes", PeakMegabytes()}};
}

}  // namespace nerf
