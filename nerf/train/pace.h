#pragma once

#include <cstdint>

#include "nerf/base/stopwatch.h"
#include "nerf/config/train_options.h"

namespace nerf {

// How far along a run is: by its steps, or by the clock where train.time_budget is set.
class Pace {
 public:
  //   spent  seconds of the budget that went before: reading photographs, a run's earlier part
  Pace(const TrainOptions& options, double spent);

  // Seconds of the budget up to now.
  double Spent() const;
  // Of the learning rate's way from its highest to its last, in [0, 1]; at 1 the run is over.
  double Progress(std::int64_t step) const;
  // The last validation and checkpoint take time too: what the latest took is kept free for them.
  void SetSecondsOfTheEnd(double seconds) { seconds_of_the_end_ = seconds; }

 private:
  std::int64_t steps_;
  double budget_;  // seconds; 0: as long as the steps take
  double spent_before_;
  double seconds_of_the_end_ = 0.3;
  Stopwatch watch_;
};

}  // namespace nerf
