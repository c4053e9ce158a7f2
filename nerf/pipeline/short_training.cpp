#include "nerf/pipeline/short_training.h"

#include <algorithm>
#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/base/stopwatch.h"
#include "nerf/model/parameters.h"
#include "nerf/train/trainer.h"

namespace nerf {
namespace {

constexpr int kTimedSteps = 10;  // per measurement

// Memory of parameters, their gradients, and Adam's two moments.
double MegabytesOf(const Model& model) {
  double bytes = 0;
  for (const auto& [name, parameter] : NamedParameters(model)) {
    bytes += 4.0 * static_cast<double>(parameter.nbytes());
  }
  return bytes * 0x1p-20;
}

// The configuration limited to a number of steps, without time budget and target.
Config ForSteps(Config config, int steps) {
  config.train.steps = steps;
  config.train.time_budget = 0;
  config.train.target_psnr = 0;
  return config;
}

}  // namespace

ShortTraining TrainShortly(const Config& config, const SceneFacts& scene, const Dataset& data,
                           int steps) {
  TORCH_CHECK(!data.validation.empty(), "TrainShortly: no validation photographs");
  const Stopwatch watch;
  Trainer trainer(ForSteps(config, steps), scene, data, {});
  std::vector<double> seconds;
  for (int done = 0; done < steps; done += kTimedSteps) {
    seconds.push_back(trainer.TakeSteps(std::min(kTimedSteps, steps - done)));
  }
  ShortTraining result;
  result.seconds_per_step = UpperMedian(seconds);
  result.psnr = trainer.ValidationPsnrAtOwnExposure();
  result.megabytes = MegabytesOf(trainer.GetModel());
  result.seconds = watch.Seconds();
  return result;
}

double EstimateSecondsPerStep(const Config& config, const SceneFacts& scene, const Dataset& data,
                              int steps) {
  const Stopwatch watch;
  Trainer trainer(ForSteps(config, steps), scene, data, {});
  const double per_step = trainer.TakeSteps(std::min(kTimedSteps, steps));
  // Set-up, and the final validation, which takes about as long as the steps taken here.
  const double overhead = watch.Seconds();
  return per_step + overhead / steps;
}

}  // namespace nerf
