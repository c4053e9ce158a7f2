#include "nerf/train/pace.h"

#include <gtest/gtest.h>

#include <thread>

namespace nerf {
namespace {

TEST(Pace, GoesByStepsWhereThereIsNoBudget) {
  TrainOptions options;
  options.steps = 200;
  const Pace pace(options, 1e6);
  EXPECT_EQ(pace.Progress(0), 0);
  EXPECT_EQ(pace.Progress(50), 0.25);
  EXPECT_EQ(pace.Progress(200), 1);
  EXPECT_EQ(pace.Progress(300), 1);
}

TEST(Pace, GoesByTheClockWhereThereIsOneWhateverTheStep) {
  TrainOptions options;
  options.time_budget = 100;
  Pace pace(options, 25);
  pace.SetSecondsOfTheEnd(0);
  EXPECT_NEAR(pace.Progress(0), 0.25, 0.01);
  EXPECT_NEAR(pace.Progress(1000000), 0.25, 0.01);
  pace.SetSecondsOfTheEnd(50);
  EXPECT_NEAR(pace.Progress(0), 0.5, 0.02);
  EXPECT_EQ(Pace(options, 100).Progress(0), 1);

  const double before = pace.Spent();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_GE(pace.Spent() - before, 0.02);
}

TEST(Pace, AnEndThatTakesLongerThanTheBudgetIsTheEnd) {
  TrainOptions options;
  options.time_budget = 1;
  Pace pace(options, 0.01);
  pace.SetSecondsOfTheEnd(5);
  EXPECT_EQ(pace.Progress(0), 1);
}

}  // namespace
}  // namespace nerf
