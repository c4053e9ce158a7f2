#pragma once

#include <nlohmann/json.hpp>

#include "nerf/render/engine.h"

namespace nerf {

// What one step took, in seconds.
struct StepSeconds {
  double all = 0;
  double pixels = 0;     // drawing them, and what their errors teach the next draw
  double occupancy = 0;  // fresh densities for the grid
  double optimizer = 0;
};

// Totals of the steps between two lines of metrics.jsonl.
class Tally {
 public:
  void Add(const StepResult& result, std::int64_t rays, const StepSeconds& seconds);

  std::int64_t Steps() const { return steps_; }
  // Means and rates, and "stage_seconds", whose parts sum to what the steps took. At least one
  // step must be in it.
  nlohmann::json Metrics() const;

 private:
  double loss_ = 0, squared_error_ = 0;
  std::int64_t steps_ = 0, rays_ = 0, marched_ = 0, shaded_ = 0;
  StepSeconds seconds_;
  StageSeconds stages_;
};

// Decibels of a mean squared error of colours in [0, 1].
double PsnrOf(double mean_squared_error);

}  // namespace nerf
