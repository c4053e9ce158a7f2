#pragma once

#include <cstdint>

#include "nerf/base/stopwatch.h"
#include "nerf/config/train_options.h"

namespace nerf {

// The progress of a training run: by steps, or by elapsed time if train.time_budget is set.
class TrainingProgress {
 public:
  //   spent_seconds  already spent: reading photographs, an earlier part of the run
  TrainingProgress(const TrainOptions& options, double spent_seconds);

  // Seconds spent so far, including those before.
  double SpentSeconds() const;
  // The position in the learning-rate schedule, in [0, 1]; at 1 the run ends.
  double Fraction(std::int64_t step) const;
  // Reserves part of the time budget for the last validation and checkpoint.
  void ReserveSeconds(double seconds) { reserved_seconds_ = seconds; }
  // Another time budget, with the reserve; the position jumps.
  void EndAt(double seconds) { budget_ = seconds; }

 private:
  std::int64_t steps_;
  double budget_;  // seconds; 0: none
  double spent_before_;
  double reserved_seconds_ = 0.3;
  Stopwatch watch_;
};

}  // namespace nerf
