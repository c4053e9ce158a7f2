#include "nerf/train/training_progress.h"

#include <algorithm>

namespace nerf {

TrainingProgress::TrainingProgress(const TrainOptions& options, double spent_seconds)
    : steps_(options.steps), budget_(options.time_budget), spent_before_(spent_seconds) {}

double TrainingProgress::SpentSeconds() const { return spent_before_ + watch_.Seconds(); }

double TrainingProgress::Fraction(std::int64_t step) const {
  if (budget_ == 0) {
    return std::min(1.0, static_cast<double>(step) / static_cast<double>(steps_));
  }
  const double available = std::max(1e-3, budget_ - reserved_seconds_);
  return std::min(1.0, SpentSeconds() / available);
}

}  // namespace nerf
