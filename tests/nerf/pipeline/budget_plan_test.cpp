#include "nerf/pipeline/budget_plan.h"

#include <gtest/gtest.h>

#include "nerf/config/config.h"

namespace nerf {
namespace {

TEST(BudgetPlan, ChoosesSmallBatchesForFewStepsAndLargeTablesForMany) {
  EXPECT_EQ(PlanFor(30, 0.05).preset, "fast");       // time for 600 steps
  EXPECT_EQ(PlanFor(124, 0.05).preset, "fast");      // 2480
  EXPECT_EQ(PlanFor(126, 0.05).preset, "balanced");  // 2520
  EXPECT_EQ(PlanFor(449, 0.05).preset, "balanced");  // 8980
  EXPECT_EQ(PlanFor(451, 0.05).preset, "accurate");  // 9020
  EXPECT_EQ(PlanFor(36000, 0.05).preset, "accurate");
}

TEST(BudgetPlan, DependsOnlyOnTheNumberOfSteps) {
  for (const double speed : {0.001, 0.05, 2.0}) {
    EXPECT_EQ(PlanFor(2000 * speed, speed).preset, "fast") << speed;
    EXPECT_EQ(PlanFor(5000 * speed, speed).preset, "balanced") << speed;
    EXPECT_EQ(PlanFor(20000 * speed, speed).preset, "accurate") << speed;
  }
}

TEST(BudgetPlan, PredictsTheStepsOfTheChosenPreset) {
  EXPECT_NEAR(PlanFor(250, 0.05).steps, 5000, 1e-6);
  EXPECT_GT(PlanFor(50, 0.05).steps, 1000);     // steps of `fast` are cheaper
  EXPECT_LT(PlanFor(1000, 0.05).steps, 20000);  // steps of `accurate` take longer
}

TEST(BudgetPlan, NamesExistingPresets) {
  for (const double seconds : {1.0, 200.0, 1e6}) {
    EXPECT_TRUE(BuiltInPresets().contains(PlanFor(seconds, 0.05).preset));
  }
  EXPECT_EQ(PlanFor(0, 0.05).preset, "fast");
}

}  // namespace
}  // namespace nerf
