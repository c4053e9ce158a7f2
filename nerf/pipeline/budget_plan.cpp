#include "nerf/pipeline/budget_plan.h"

#include <algorithm>

namespace nerf {
namespace {

// The first steps touch memory for the first time.
constexpr int kFirstSteps = 5;
constexpr int kTimedSteps = 15;

// Up to so many steps half the batch and twice the steps are better, measured on the fox: 0.7 dB at
// 800 steps, 0.4 dB at 1600; at 5000 they are alike.
constexpr double kStepsOfSmallBatches = 2500;

// Steps from which on tables of 2^19 entries are better than those of 2^17, measured on the fox and
// the chair.
constexpr double kStepsOfLargeTables = 9000;

// What a step of each takes, in steps of `balanced`.
constexpr double kCostOfFast = 0.55, kCostOfAccurate = 1.25;

}  // namespace

BudgetPlan PlanFor(double seconds, double seconds_a_step) {
  const double steps = seconds / std::max(1e-6, seconds_a_step);
  if (steps < kStepsOfSmallBatches) return {"fast", steps / kCostOfFast};
  if (steps < kStepsOfLargeTables) return {"balanced", steps};
  return {"accurate", steps / kCostOfAccurate};
}

BudgetPlan PlanBudget(Trainer& balanced, double seconds) {
  balanced.TakeSteps(kFirstSteps);
  return PlanFor(seconds, balanced.TakeSteps(kTimedSteps));
}

}  // namespace nerf
