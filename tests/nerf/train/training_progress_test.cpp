#include "nerf/train/training_progress.h"

#include <gtest/gtest.h>

#include <thread>

namespace nerf {
namespace {

TEST(TrainingProgress, CountsStepsWithoutATimeBudget) {
  TrainOptions options;
  options.steps = 200;
  const TrainingProgress progress(options, 1e6);
  EXPECT_EQ(progress.Fraction(0), 0);
  EXPECT_EQ(progress.Fraction(50), 0.25);
  EXPECT_EQ(progress.Fraction(200), 1);
  EXPECT_EQ(progress.Fraction(300), 1);
}

TEST(TrainingProgress, FollowsTheClockWithATimeBudget) {
  TrainOptions options;
  options.time_budget = 100;
  TrainingProgress progress(options, 25);
  progress.ReserveSeconds(0);
  EXPECT_NEAR(progress.Fraction(0), 0.25, 0.01);
  EXPECT_NEAR(progress.Fraction(1000000), 0.25, 0.01);
  progress.ReserveSeconds(50);
  EXPECT_NEAR(progress.Fraction(0), 0.5, 0.02);
  EXPECT_EQ(TrainingProgress(options, 100).Fraction(0), 1);

  const double before = progress.SpentSeconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_GE(progress.SpentSeconds() - before, 0.02);
}

TEST(TrainingProgress, IsCompleteWhereTheReservedTimeExceedsTheBudget) {
  TrainOptions options;
  options.time_budget = 1;
  TrainingProgress progress(options, 0.01);
  progress.ReserveSeconds(5);
  EXPECT_EQ(progress.Fraction(0), 1);
}

}  // namespace
}  // namespace nerf
