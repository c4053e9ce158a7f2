#include "nerf/pipeline/trial_allowance.h"

#include <cmath>
#include <limits>

namespace nerf {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

}  // namespace

TrialAllowance::TrialAllowance(const TrainOptions& options, double seconds_left,
                               std::int64_t samples)
    : seconds_left_(options.time_budget > 0 ? seconds_left : kNoEnd),
      steps_(options.time_budget > 0 ? kNoEnd
                                     : static_cast<double>(options.steps) *
                                           static_cast<double>(options.samples_per_batch) /
                                           static_cast<double>(samples)) {}

bool TrialAllowance::Has(int more, double seconds_a_step, double share, double spent) const {
  return done_ + more <= share * steps_ &&
         spent + more * seconds_a_step <= share / (1 + share) * seconds_left_;
}

bool TrialAllowance::IsByTheClock() const { return std::isfinite(seconds_left_); }

}  // namespace nerf
