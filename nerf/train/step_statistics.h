#pragma once

#include <nlohmann/json.hpp>

#include "nerf/render/engine.h"

namespace nerf {

// The time of one step, seconds.
struct StepSeconds {
  double all = 0;
  double pixels = 0;     // sampling pixels and updating the error map
  double occupancy = 0;  // updating the occupancy grid
  double optimizer = 0;
};

// Statistics of the steps between two lines of metrics.jsonl.
class StepStatistics {
 public:
  void Add(const StepResult& result, std::int64_t rays, const StepSeconds& seconds);

  std::int64_t Steps() const { return steps_; }
  // Means and rates, and "stage_seconds", which sum to the time of the steps. Needs at least one
  // step.
  nlohmann::json Metrics() const;

 private:
  double loss_ = 0, squared_error_ = 0;
  std::int64_t steps_ = 0, rays_ = 0, marched_ = 0, shaded_ = 0;
  StepSeconds seconds_;
  StageSeconds stages_;
};

// PSNR, dB, of colours in [0, 1].
double PsnrFromMse(double mean_squared_error);

}  // namespace nerf
