#include "nerf/train/pace.h"

#include <algorithm>

namespace nerf {

Pace::Pace(const TrainOptions& options, double spent)
    : steps_(options.steps), budget_(options.time_budget), spent_before_(spent) {}

double Pace::Spent() const { return spent_before_ + watch_.Seconds(); }

double Pace::Progress(std::int64_t step) const {
  if (budget_ == 0) {
    return std::min(1.0, static_cast<double>(step) / static_cast<double>(steps_));
  }
  const double of_steps = std::max(1e-3, budget_ - seconds_of_the_end_);
  return std::min(1.0, Spent() / of_steps);
}

}  // namespace nerf
