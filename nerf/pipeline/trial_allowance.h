#pragma once

#include <cstdint>

#include "nerf/config/train_options.h"

namespace nerf {

// How long trials of effects may go on: by the clock where a training ends by it, else by their
// steps, as a part of those of the training with as many samples.
class TrialAllowance {
 public:
  //   seconds_left  of the time budget, where there is one, when trials begin
  //   samples       that a step of a trial takes
  TrialAllowance(const TrainOptions& options, double seconds_left, std::int64_t samples);

  // Whether so many steps more fit into a share of the training that follows the trials.
  //   spent  seconds since trials began
  bool Has(int more, double seconds_a_step, double share, double spent) const;
  void Count(int steps) { done_ += steps; }
  bool IsByTheClock() const;

 private:
  double seconds_left_, steps_;  // of the training
  int done_ = 0;
};

}  // namespace nerf
