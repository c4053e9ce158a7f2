#pragma once

#include <cstdint>

#include "nerf/config/train_options.h"

namespace nerf {

// Limits the cost of effect trials relative to the training: by time if there is a time budget,
// otherwise by steps with the same number of samples.
class TrialAllowance {
 public:
  //   seconds_left  of the time budget, if there is one, when trials begin
  //   samples       per step of a trial
  TrialAllowance(const TrainOptions& options, double seconds_left, std::int64_t samples);

  // Whether `steps` more steps are within a share of the training that follows the trials.
  //   spent_seconds  since trials began
  bool Allows(int steps, double seconds_per_step, double share, double spent_seconds) const;
  void Count(int steps) { done_ += steps; }
  bool UsesClock() const;

 private:
  double seconds_left_, steps_;  // of the training
  int done_ = 0;
};

}  // namespace nerf
