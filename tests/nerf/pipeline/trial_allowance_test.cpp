#include "nerf/pipeline/trial_allowance.h"

#include <gtest/gtest.h>

namespace nerf {
namespace {

constexpr double kShare = 0.25;

TEST(TrialAllowance, IsAShareOfTheStepsWithAsManySamples) {
  TrainOptions options;
  options.steps = 1000;
  options.samples_per_batch = 2000;
  TrialAllowance allowance(options, -1, 1000);  // so 2000 steps of a trial's samples
  EXPECT_FALSE(allowance.IsByTheClock());
  EXPECT_TRUE(allowance.Has(500, 1e9, kShare, 1e9));
  EXPECT_FALSE(allowance.Has(501, 0, kShare, 0));
  allowance.Count(400);
  EXPECT_TRUE(allowance.Has(100, 0, kShare, 0));
  EXPECT_FALSE(allowance.Has(101, 0, kShare, 0));
  EXPECT_FALSE(allowance.Has(100, 0, kShare / 2, 0)) << "all trials together";
}

TEST(TrialAllowance, IsAShareOfWhatTheClockLeavesToTraining) {
  TrainOptions options;
  options.time_budget = 100;
  options.steps = 1;  // count for nothing
  TrialAllowance allowance(options, 50, 1000);
  EXPECT_TRUE(allowance.IsByTheClock());
  // 10 of 50 seconds are a quarter of the 40 that follow.
  EXPECT_TRUE(allowance.Has(100, 0.099, kShare, 0));
  EXPECT_FALSE(allowance.Has(100, 0.101, kShare, 0));
  EXPECT_TRUE(allowance.Has(50, 0.099, kShare, 5));
  EXPECT_FALSE(allowance.Has(50, 0.101, kShare, 5));
  allowance.Count(1000000);
  EXPECT_TRUE(allowance.Has(50, 0.099, kShare, 5));
}

TEST(TrialAllowance, IsNothingWhereTheBudgetIsGone) {
  TrainOptions options;
  options.time_budget = 100;
  EXPECT_FALSE(TrialAllowance(options, -3, 1000).Has(1, 1e-9, kShare, 0));
}

}  // namespace
}  // namespace nerf
