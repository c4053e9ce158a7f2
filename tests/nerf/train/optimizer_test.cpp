#include "nerf/train/optimizer.h"

#include <gtest/gtest.h>

#include "nerf/train/non_finite_error.h"

namespace nerf {
namespace {

OptimizerOptions Options() {
  OptimizerOptions options;
  options.weight_decay = 0.01;
  return options;
}

TEST(Adam, GivesTheNumbersOfLibTorchsOwn) {
  torch::manual_seed(1);
  torch::Tensor ours = torch::randn({30, 7}).requires_grad_();
  torch::Tensor theirs = ours.detach().clone().requires_grad_();
  const OptimizerOptions options = Options();
  Adam adam({{"weight", ours}}, options);
  torch::optim::Adam reference({theirs}, torch::optim::AdamOptions(options.learning_rate)
                                             .betas({options.beta1, options.beta2})
                                             .eps(options.epsilon)
                                             .weight_decay(options.weight_decay));
  for (int step = 0; step < 20; ++step) {
    const torch::Tensor target = torch::randn({30, 7});
    (ours - target).square().sum().backward();
    reference.zero_grad();
    (theirs - target).square().sum().backward();
    adam.Step(1.0);
    reference.step();
    EXPECT_TRUE(torch::allclose(ours, theirs, 1e-4, 1e-6)) << "step " << step;
    EXPECT_FALSE(ours.grad().defined());
  }
}

TEST(Adam, TablesDoNotDecay) {
  torch::Tensor table = torch::ones({4, 2}).requires_grad_();
  Adam adam({{"hash_encoding.table", table}}, Options());
  adam.Step(1.0);
  EXPECT_TRUE(torch::equal(table, torch::ones({4, 2})));
}

TEST(Adam, GoesOnFromItsSavedState) {
  const auto gradient = [](int step) { return torch::full({5}, std::cos(step)); };
  const auto train = [&](Adam& adam, torch::Tensor& x, int from, int to) {
    for (int step = from; step < to; ++step) {
      x.mutable_grad() = gradient(step);
      adam.Step(1.0);
    }
  };
  torch::Tensor straight = torch::ones({5}).requires_grad_();
  Adam one({{"w", straight}}, Options());
  train(one, straight, 0, 20);

  torch::Tensor broken = torch::ones({5}).requires_grad_();
  Adam first({{"w", broken}}, Options());
  train(first, broken, 0, 10);
  std::map<std::string, torch::Tensor> saved;
  first.AddTo(saved);
  Adam second({{"w", broken}}, Options());
  second.LoadFrom(saved);
  train(second, broken, 10, 20);
  EXPECT_TRUE(torch::equal(straight, broken));
}

TEST(Adam, NamesTheParameterWhoseGradientIsNotFinite) {
  torch::Tensor x = torch::ones({5}).requires_grad_();
  Adam adam({{"some.weight", x}}, Options());
  x.mutable_grad() = torch::full({5}, NAN);
  try {
    adam.Step(1.0);
    FAIL();
  } catch (const NonFiniteError& error) {
    EXPECT_NE(std::string(error.what()).find("some.weight"), std::string::npos);
  }
}

TEST(LearningRate, RisesThenFallsToItsFinalValue) {
  ScheduleOptions schedule;
  schedule.warmup_steps = 10;
  schedule.final_factor = 0.1;
  EXPECT_NEAR(LearningRateFactor(schedule, 0, 1000), 0.1, 1e-3);
  EXPECT_NEAR(LearningRateFactor(schedule, 10, 1000), 1.0, 1e-3);
  EXPECT_NEAR(LearningRateFactor(schedule, 1000, 1000), 0.1, 1e-9);
  for (int step = 10; step < 1000; ++step) {
    EXPECT_GT(LearningRateFactor(schedule, step, 1000),
              LearningRateFactor(schedule, step + 1, 1000));
  }
}

}  // namespace
}  // namespace nerf
