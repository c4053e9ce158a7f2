#pragma once

#include <string>

#include "nerf/train/trainer.h"

namespace nerf {

// What a time budget is best spent on, on this machine.
struct BudgetPlan {
  std::string preset;  // "fast", "balanced" or "accurate"
  double steps = 0;    // that there is time for, about
};

// Times some steps of a trainer of the preset `balanced` (they are its first, and not lost where
// that preset is chosen). Where there is time for few of them, the many small steps of `fast` learn
// more; where there is time for more than small hash tables make use of, `accurate` does.
//   seconds  what is left of the budget
BudgetPlan PlanBudget(Trainer& balanced, double seconds);

}  // namespace nerf
