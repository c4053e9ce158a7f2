#include <gtest/gtest.h>

#include "nerf/render/losses.h"
#include "tests/support/central_differences.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

TEST(RobustLoss, IsTheOrdinaryLossWhereErrorsAreSmall) {
  const torch::Tensor target = torch::full({4, 3}, 0.5), predicted = target + 1e-3;
  const double plain = ColorLoss(predicted, target, {}, {}).item<double>();
  const double robust = ColorLoss(predicted, target, {}, RobustOptions()).item<double>();
  EXPECT_NEAR(robust / plain, 1, 1e-3);
}

TEST(RobustLoss, ALargeErrorHasASmallerGradientThanASmallOne) {
  const auto gradient = [](double error) {
    const torch::Tensor target = torch::zeros({1, 3}, torch::kDouble);
    const torch::Tensor predicted = torch::full({1, 3}, error, torch::kDouble).requires_grad_(true);
    ColorLoss(predicted, target, {}, RobustOptions()).backward();
    return predicted.grad()[0][0].item<double>();
  };
  EXPECT_LT(gradient(0.8), 0.1 * gradient(0.05));
  EXPECT_GT(gradient(0.8), 0);
}

TEST(RobustLoss, IsTheOrdinaryLossAtTheBeginningOfTraining) {
  const RobustOptions options;
  EXPECT_NEAR(options.At(0).scale, 100 * options.scale, 1e-9);
  EXPECT_NEAR(options.At(0.5).scale, options.scale, 1e-12);
  EXPECT_NEAR(options.At(1).scale, options.scale, 1e-12);
  const torch::Tensor target = torch::zeros({4, 3}), predicted = torch::full({4, 3}, 0.3);
  const double plain = ColorLoss(predicted, target, {}, {}).item<double>();
  EXPECT_NEAR(ColorLoss(predicted, target, {}, options.At(0)).item<double>() / plain, 1, 0.06);
}

TEST(RobustLoss, GradientsMatchCentralDifferences) {
  const torch::Tensor target = torch::rand({6, 3}, torch::kDouble);
  const torch::Tensor predicted =
      torch::rand({6, 3}, torch::dtype(torch::kDouble)).requires_grad_(true);
  for (const LossKind kind : {LossKind::kHuber, LossKind::kMse}) {
    LossOptions loss;
    loss.kind = kind;
    test::ExpectGradientMatchesCentralDifferences(
        [&] { return ColorLoss(predicted, target, loss, RobustOptions()); }, predicted, 1e-6, 1e-7);
  }
}

TEST(RobustLoss, WithAHugeScaleChangesNoBit) {
  test::TwoEngines off, huge;
  huge.robust = RobustOptions{1e300};
  off.Make(50);
  huge.Make(50);
  for (const auto engine : {&test::TwoEngines::libtorch, &test::TwoEngines::fused}) {
    const StepResult a = (off.*engine)->AccumulateGradients(off.batch);
    const StepResult b = (huge.*engine)->AccumulateGradients(huge.batch);
    EXPECT_EQ(a.loss, b.loss);
    EXPECT_EQ(a.ray_error, b.ray_error);
  }
}

TEST(RobustLoss, IsTheSameInBothEngines) {
  for (const LossKind kind : {LossKind::kHuber, LossKind::kMse}) {
    test::TwoEngines e;
    e.loss.kind = kind;
    e.robust = RobustOptions();
    e.Make(50);
    for (const double progress : {0.0, 0.3, 1.0}) {
      e.context.progress = progress;
      e.ExpectTheSame();
    }
  }
}

}  // namespace
}  // namespace nerf
