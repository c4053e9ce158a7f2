#include "nerf/pipeline/trial_allowance.h"

#include <cmath>
#include <limits>

namespace nerf {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

}  // namespace

TrialAllowance::TrialAllowance(const TrainOptions& options, double seconds_left,
                               std::int64_t samples)
    : seconds_left_(options.time_budget > 0 ? seconds_left : kUnlimited),
      steps_(options.time_budget > 0 ? kUnlimited
                                     : static_cast<double>(options.steps) *
                                           static_cast<double>(options.samples_per_batch) /
                                           static_cast<double>(samples)) {}

bool TrialAllowance::Allows(int steps, double seconds_per_step, double share,
                            double spent_seconds) const {
  return done_ + steps <= share * steps_ &&
         spent_seconds + steps * seconds_per_step <= share / (1 + share) * seconds_left_;
}

bool TrialAllowance::UsesClock() const { return std::isfinite(seconds_left_); }

}  // namespace nerf
