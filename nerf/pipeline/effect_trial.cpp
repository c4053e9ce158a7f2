#include "nerf/pipeline/effect_trial.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "nerf/base/stopwatch.h"
#include "nerf/model/parameters.h"
#include "nerf/train/trainer.h"

namespace nerf {
namespace {

constexpr int kTimed = 10;  // steps at a time

}  // namespace

double MegabytesOf(const Model& model) {
  double bytes = 0;
  for (const auto& [name, parameter] : NamedParameters(model)) {
    bytes += 4.0 * static_cast<double>(parameter.nbytes());
  }
  return bytes * 0x1p-20;
}

TrialResult TryConfig(Config config, const SceneFacts& scene, const Dataset& data, int steps) {
  TORCH_CHECK(!data.validation.empty(), "TryConfig: no validation photographs");
  config.train.steps = steps;
  config.train.time_budget = 0;
  config.train.target_psnr = 0;
  const Stopwatch watch;
  Trainer trainer(config, scene, data, {});
  std::vector<double> seconds;
  for (int done = 0; done < steps; done += kTimed) {
    seconds.push_back(trainer.TrySteps(std::min(kTimed, steps - done)));
  }
  std::ranges::nth_element(seconds,
                           seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2));
  TrialResult result;
  result.seconds_a_step = seconds[seconds.size() / 2];
  result.psnr = trainer.ValidationPsnrAtOwnExposure();
  result.megabytes = MegabytesOf(trainer.GetModel());
  result.seconds = watch.Seconds();
  return result;
}

double EstimateSecondsOfAStep(Config config, const SceneFacts& scene, const Dataset& data,
                              int steps) {
  config.train.steps = steps;
  config.train.time_budget = 0;
  config.train.target_psnr = 0;
  const Stopwatch watch;
  Trainer trainer(config, scene, data, {});
  const double of_step = trainer.TrySteps(std::min(kTimed, steps));
  // Beginning, and measuring at the end, which takes about as long as these steps did.
  const double all_else = watch.Seconds();
  return of_step + all_else / steps;
}

Config WithEffect(const Config& config, const std::string& effect, const std::string& setting) {
  nlohmann::json json = JsonFromConfig(config);
  json["effects"][effect] = nlohmann::json::parse(setting);
  return ConfigFromJson(json, "effects." + effect);
}

bool Simulates(const Config& config, const std::string& effect) {
  return !JsonFromConfig(config).at("effects").at(effect).is_null();
}

}  // namespace nerf
