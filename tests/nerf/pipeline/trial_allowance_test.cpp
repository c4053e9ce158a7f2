#include "nerf/pipeline/trial_allowance.h"

#include <gtest/gtest.h>

namespace nerf {
namespace {

constexpr double kShare = 0.25;

TEST(TrialAllowance, IsAShareOfTheStepsWithTheSameNumberOfSamples) {
  TrainOptions options;
  options.steps = 1000;
  options.samples_per_batch = 2000;
  TrialAllowance allowance(options, -1, 1000);  // equals 2000 steps of a trial
  EXPECT_FALSE(allowance.UsesClock());
  EXPECT_TRUE(allowance.Allows(500, 1e9, kShare, 1e9));
  EXPECT_FALSE(allowance.Allows(501, 0, kShare, 0));
  allowance.Count(400);
  EXPECT_TRUE(allowance.Allows(100, 0, kShare, 0));
  EXPECT_FALSE(allowance.Allows(101, 0, kShare, 0));
  EXPECT_FALSE(allowance.Allows(100, 0, kShare / 2, 0)) << "the limit is for all trials together";
}

TEST(TrialAllowance, IsAShareOfTheRemainingTime) {
  TrainOptions options;
  options.time_budget = 100;
  options.steps = 1;  // ignored with a time budget
  TrialAllowance allowance(options, 50, 1000);
  EXPECT_TRUE(allowance.UsesClock());
  // 10 of 50 seconds are a quarter of the remaining 40.
  EXPECT_TRUE(allowance.Allows(100, 0.099, kShare, 0));
  EXPECT_FALSE(allowance.Allows(100, 0.101, kShare, 0));
  EXPECT_TRUE(allowance.Allows(50, 0.099, kShare, 5));
  EXPECT_FALSE(allowance.Allows(50, 0.101, kShare, 5));
  allowance.Count(1000000);
  EXPECT_TRUE(allowance.Allows(50, 0.099, kShare, 5));
}

TEST(TrialAllowance, IsZeroWhenTheBudgetIsSpent) {
  TrainOptions options;
  options.time_budget = 100;
  EXPECT_FALSE(TrialAllowance(options, -3, 1000).Allows(1, 1e-9, kShare, 0));
}

}  // namespace
}  // namespace nerf
