#include "nerf/commands/effects_trials.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "nerf/stopwatch.h"
#include "nerf/train/effect_trial.h"
#include "nerf/train/held_out.h"

namespace nerf {
namespace {

// What a short training can tell: the others are facts, or need what is not at hand.
const std::set<std::string> kTried = {"exposure", "view", "robust", "poses", "footprint"};
constexpr int kSteps = 200;
constexpr std::int64_t kSamples = 16384;  // a step
constexpr double kWorthIt = 0.2;          // dB, more than the noise of a trial
constexpr double kShortestBudget = 120;   // seconds; of a shorter one trials would take too much,
constexpr double kShortestRun = 10.0 * kSteps * kSamples;  // as of a run of fewer samples
constexpr std::size_t kFewestHeldOut = 2;  // on one photograph a difference is chance

// Where nothing tells at all, exposure alone is tried: photographs often differ in it, and it may
// be worth ten decibels.
bool IsOpen(const Verdict& verdict, const std::set<std::string>& named) {
  if (verdict.IsSure() || named.contains(verdict.effect)) return false;
  return verdict.decided ? kTried.contains(verdict.effect) : verdict.effect == "exposure";
}

bool IsWorthATrial(const TrainOptions& options) {
  if (options.time_budget > 0) return options.time_budget >= kShortestBudget;
  return static_cast<double>(options.steps) * static_cast<double>(options.samples_per_batch) >=
         kShortestRun;
}

}  // namespace

EffectTrials TryWhatIsOpen(const Config& config, const SceneFacts& scene,
                           const std::set<std::string>& named, Dataset& data,
                           std::vector<Verdict>& verdicts) {
  EffectTrials trials;
  const bool any =
      std::ranges::any_of(verdicts, [&](const Verdict& v) { return IsOpen(v, named); });
  if (!any || !IsWorthATrial(config.train)) return trials;
  const Stopwatch watch;
  const HeldOut held_out(data, scene);
  if (data.validation.size() < kFewestHeldOut) return trials;
  Config trial = config;
  trial.train.samples_per_batch = kSamples;
  const auto psnr_of = [&](const Config& tried) {
    return TryConfig(tried, held_out.Scene(), data, kSteps).psnr;
  };
  std::optional<double> as_it_is;  // the PSNR of `trial`
  for (Verdict& verdict : verdicts) {
    if (!IsOpen(verdict, named)) continue;
    const bool is_on = Simulates(trial, verdict.effect);
    const Config other = WithEffect(trial, verdict.effect, is_on ? "null" : "{}");
    if (!as_it_is) as_it_is = psnr_of(trial);
    const double otherwise = psnr_of(other);
    const double with = is_on ? *as_it_is : otherwise, without = is_on ? otherwise : *as_it_is;
    verdict = Tried(verdict, with, without, kWorthIt);
    if (verdict.on != is_on) {
      trial = other;
      as_it_is = otherwise;
    }
    trials.assignments.push_back(verdict.assignment);
    fmt::print("{}", RowOf(verdict));
  }
  trials.seconds = watch.Seconds();
  fmt::print("tried for {:.1f} s\n", trials.seconds);
  std::fflush(stdout);
  return trials;
}

}  // namespace nerf
