#pragma once

#include <string>

#include "nerf/train/trainer.h"

namespace nerf {

// What a time budget is best spent on, on this machine.
struct BudgetPlan {
  std::string preset;  // "fast", "balanced" or "accurate"
  double steps = 0;    // that there is time for, about
};

// Where there is time for few steps, the many small ones of `fast` learn more than those of
// `balanced`; where there is time for more than small hash tables make use of, `accurate` does.
//   seconds          what is left of the budget
//   seconds_a_step   of the preset balanced
BudgetPlan PlanFor(double seconds, double seconds_a_step);

// PlanFor the speed of a trainer of the preset `balanced`: times some of its steps (they are its
// first, and not lost where that preset is chosen).
BudgetPlan PlanBudget(Trainer& balanced, double seconds);

}  // namespace nerf
