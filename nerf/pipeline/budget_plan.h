#pragma once

#include <string>

#include "nerf/train/trainer.h"

namespace nerf {

// The best preset for a time budget on this machine.
struct BudgetPlan {
  std::string preset;  // "fast", "balanced" or "accurate"
  double steps = 0;    // approximate number of steps in the budget
};

// Chooses a preset by the number of steps of `balanced` that fit: `fast` makes more and smaller
// steps, which is better for few steps; `accurate` has larger hash tables, which is better for
// many.
//   seconds           remaining time budget
//   seconds_per_step  of the preset `balanced`
BudgetPlan PlanFor(double seconds, double seconds_per_step);

// PlanFor the measured speed of a trainer of the preset `balanced`. Takes its first steps, which
// count if that preset is chosen.
BudgetPlan PlanBudget(Trainer& balanced, double seconds);

}  // namespace nerf
