#include "nerf/train/optimizer.h"

#include <gtest/gtest.h>
#include <torch/optim/adam.h>

#include "nerf/render/non_finite_error.h"

namespace nerf {
namespace {

OptimizerOptions Options() {
  OptimizerOptions options;
  options.weight_decay = 0.01;
  return options;
}

TEST(Adam, EqualsLibTorchsAdam) {
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
    adam.step();
    reference.step();
    EXPECT_TRUE(torch::allclose(ours, theirs, 1e-4, 1e-6)) << "step " << step;
    EXPECT_EQ(ours.grad().abs().max().item<float>(), 0.0f) << "gradients must be reset";
  }
}

TEST(Adam, AStepIsProportionalToTheLearningRateFactor) {
  const auto change = [](double factor) {
    torch::Tensor weight = torch::ones({3, 2}).requires_grad_();
    Adam adam({{"weight", weight}}, OptimizerOptions());
    weight.sum().backward();
    adam.Step(factor);
    return (1 - weight).mean().item<double>();
  };
  EXPECT_NEAR(change(1), OptimizerOptions().learning_rate, 1e-6);
  EXPECT_NEAR(change(0.25), 0.25 * change(1), 1e-6);
  EXPECT_EQ(change(0), 0);
}

// An entry without a gradient in some steps is updated as if these steps had not happened.
TEST(Adam, EachEntryOfATableCountsItsOwnSteps) {
  for (const int features : {1, 2, 4, 8}) {
    torch::manual_seed(1);
    torch::Tensor table = torch::ones({3, features}).requires_grad_();
    Adam adam({{"hash_encoding.table", table}}, Options());
    OptimizerOptions options = Options();
    options.weight_decay = 0;
    torch::Tensor always = torch::ones({features}).requires_grad_();
    torch::Tensor sometimes = always.detach().clone().requires_grad_();
    Adam of_always({{"w", always}}, options), of_sometimes({{"w", sometimes}}, options);
    for (int step = 0; step < 30; ++step) {
      torch::Tensor gradient = torch::randn({3, features});
      gradient[2].zero_();
      always.mutable_grad() = gradient[0].clone();
      of_always.step();
      if (step >= 10 && step % 3 == 0) {
        sometimes.mutable_grad() = gradient[1].clone();
        of_sometimes.step();
      } else {
        gradient[1].zero_();
      }
      table.mutable_grad() = gradient;
      adam.step();
      EXPECT_EQ(gradient.abs().max().item<float>(), 0.0f);
    }
    EXPECT_TRUE(torch::allclose(table[0], always, 1e-5, 1e-6));
    EXPECT_TRUE(torch::allclose(table[1], sometimes, 1e-5, 1e-6));
    EXPECT_TRUE(torch::equal(table[2], torch::ones({features}))) << "it never had a gradient";
  }
}

TEST(Adam, UpdatesAnEntryIfAnyFeatureHasAGradient) {
  torch::Tensor table = torch::ones({1, 4}).requires_grad_();
  Adam adam({{"table", table}}, Options());
  table.mutable_grad() = torch::tensor({{0.0f, 0.0f, 0.0f, 1.0f}});
  adam.step();
  EXPECT_EQ(table[0][0].item<float>(), 1.0f);
  EXPECT_LT(table[0][3].item<float>(), 1.0f);
}

TEST(Adam, ResumesFromItsSavedState) {
  const auto gradient = [](int step) { return torch::full({5}, std::cos(step)); };
  const auto train = [&](Adam& adam, torch::Tensor& x, int from, int to) {
    for (int step = from; step < to; ++step) {
      x.mutable_grad() = gradient(step);
      adam.step();
    }
  };
  torch::Tensor uninterrupted = torch::ones({5}).requires_grad_();
  Adam one({{"w", uninterrupted}}, Options());
  train(one, uninterrupted, 0, 20);

  torch::Tensor resumed = torch::ones({5}).requires_grad_();
  Adam first({{"w", resumed}}, Options());
  train(first, resumed, 0, 10);
  std::map<std::string, torch::Tensor> saved;
  first.AddTo(saved);
  Adam second({{"w", resumed}}, Options());
  second.LoadFrom(saved);
  train(second, resumed, 10, 20);
  EXPECT_TRUE(torch::equal(uninterrupted, resumed));
}

TEST(Adam, NamesTheParameterWhoseGradientIsNotFinite) {
  torch::Tensor x = torch::ones({5}).requires_grad_();
  torch::Tensor table = torch::ones({5, 2}).requires_grad_();
  for (const auto& [name, parameter] :
       {std::pair<std::string, torch::Tensor>{"some.weight", x}, {"some.table", table}}) {
    for (const float bad : {NAN, INFINITY}) {
      Adam adam({{name, parameter}}, Options());
      parameter.mutable_grad() = torch::zeros_like(parameter);
      parameter.mutable_grad().view(-1)[3] = bad;
      try {
        adam.step();
        FAIL();
      } catch (const NonFiniteError& error) {
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
      }
    }
  }
}

TEST(LearningRate, RisesThenFallsToItsFinalValue) {
  ScheduleOptions schedule;
  schedule.warmup_steps = 10;
  schedule.final_factor = 0.1;
  EXPECT_NEAR(LearningRateFactor(schedule, 0, 0), 0.1, 1e-3);
  EXPECT_NEAR(LearningRateFactor(schedule, 10, 0.01), 1.0, 1e-3);
  EXPECT_NEAR(LearningRateFactor(schedule, 1000, 1), 0.1, 1e-9);
  for (int step = 10; step < 1000; ++step) {
    EXPECT_GT(LearningRateFactor(schedule, step, step / 1000.0),
              LearningRateFactor(schedule, step + 1, (step + 1) / 1000.0));
  }
}

}  // namespace
}  // namespace nerf
