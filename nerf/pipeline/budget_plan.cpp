#include "nerf/pipeline/budget_plan.h"

#include <algorithm>

namespace nerf {
namespace {

// Not timed, because they allocate memory.
constexpr int kFirstSteps = 5;
constexpr int kTimedSteps = 15;

// Below this many steps, half the batch and twice the steps are better: on the fox by 0.7 dB at 800
// steps and by 0.4 dB at 1600; at 5000 there is no difference.
constexpr double kMaxStepsOfFast = 2500;

// From this many steps on, tables of 2^19 entries are better than those of 2^17, on the fox and the
// chair.
constexpr double kMinStepsOfAccurate = 9000;

// The time of a step relative to a step of `balanced`.
constexpr double kCostOfFast = 0.55, kCostOfAccurate = 1.25;

}  // namespace

BudgetPlan PlanFor(double seconds, double seconds_per_step) {
  const double steps = seconds / std::max(1e-6, seconds_per_step);
  if (steps < kMaxStepsOfFast) return {"fast", steps / kCostOfFast};
  if (steps < kMinStepsOfAccurate) return {"balanced", steps};
  return {"accurate", steps / kCostOfAccurate};
}

BudgetPlan PlanBudget(Trainer& balanced, double seconds) {
  balanced.TakeSteps(kFirstSteps);
  return PlanFor(seconds, balanced.TakeSteps(kTimedSteps));
}

}  // namespace nerf
