#include "nerf/pipeline/effects_trials.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>

#include "nerf/base/stopwatch.h"
#include "nerf/pipeline/effect_trial.h"
#include "nerf/pipeline/held_out.h"
#include "nerf/pipeline/trial_allowance.h"
#include "nerf/render/non_finite_error.h"

namespace nerf {
namespace {

constexpr std::int64_t kSamples = 16384;  // a step
constexpr double kWorthIt = 0.2;          // dB, more than the noise of a trial
// Of the training, that trials may take: where the evidence is in between, and where there is none
// and they are most often for nothing. While a field learns fast, as the chair in its first
// minutes, a twentieth of the time is a tenth of a decibel.
constexpr double kShare = 1.0 / 7, kShareUnasked = 1.0 / 20;
constexpr double kFastest = 0.01;          // seconds of a step, while no more is known
constexpr std::size_t kFewestHeldOut = 2;  // on one photograph a difference is chance

// Steps of a trial. Poses must be found before they are worth anything.
int StepsOf(const std::string& effect) { return effect == "poses" ? 400 : 200; }

// A training that comes to no number is worth nothing.
TrialResult TryIt(const Config& trial, const SceneFacts& scene, const Dataset& data, int steps) {
  try {
    return TryConfig(trial, scene, data, steps);
  } catch (const NonFiniteError&) {
    TrialResult lost;
    lost.psnr = -std::numeric_limits<double>::infinity();
    return lost;
  }
}

// What EstimateSecondsOfAStep says; 0 of a training that comes to no number, as trying it will
// tell.
double EstimateOrZero(const Config& trial, const SceneFacts& scene, const Dataset& data,
                      int steps) {
  try {
    return EstimateSecondsOfAStep(trial, scene, data, steps);
  } catch (const NonFiniteError&) {
    return 0;
  }
}

}  // namespace

bool IsOpen(const Verdict& verdict, const std::set<std::string>& named) {
  if (verdict.IsConclusive() || named.contains(verdict.effect)) return false;
  return verdict.decided || verdict.effect == "exposure";
}

EffectTrials TryWhatIsOpen(const Config& config, const SceneFacts& scene,
                           const std::set<std::string>& named, double seconds_left, Dataset& data,
                           std::vector<Verdict>& verdicts) {
  EffectTrials trials;
  TrialAllowance allowance(config.train, seconds_left, kSamples);
  const Stopwatch watch;
  const HeldOutHalves held_out(data);
  if (held_out.Count() < kFewestHeldOut) return trials;
  Config trial = config;
  trial.train.samples_per_batch = kSamples;
  double seconds_a_step = 0;       // not known yet
  std::map<int, double> as_it_is;  // PSNR of `trial` after so many steps
  const auto psnr_of = [&](const Config& tried, int steps) {
    allowance.Count(steps);
    const TrialResult result = TryIt(tried, scene, data, steps);
    if (result.seconds > 0) seconds_a_step = result.seconds / steps;
    return result.psnr;
  };
  bool has_begun = false;
  for (Verdict& verdict : verdicts) {
    const int steps = StepsOf(verdict.effect);
    const int needed = as_it_is.contains(steps) ? steps : 2 * steps;
    const double share = verdict.decided ? kShare : kShareUnasked;
    if (!IsOpen(verdict, named)) continue;
    const auto fits = [&](double each) {
      return allowance.Has(needed, each, share, watch.Seconds());
    };
    if (!fits(seconds_a_step == 0 ? kFastest : seconds_a_step)) continue;
    if (seconds_a_step == 0 && allowance.IsByTheClock()) {
      seconds_a_step = EstimateOrZero(trial, scene, data, steps);
      if (!fits(seconds_a_step)) continue;
    }
    has_begun = true;
    const bool is_on = Simulates(trial, verdict.effect);
    const Config other = WithEffect(trial, verdict.effect, is_on ? "null" : "{}");
    if (!as_it_is.contains(steps)) as_it_is[steps] = psnr_of(trial, steps);
    const double as_before = as_it_is[steps], otherwise = psnr_of(other, steps);
    const double with = is_on ? as_before : otherwise, without = is_on ? otherwise : as_before;
    if (!std::isfinite(with - without)) {
      spdlog::warn("effects: a trial of {} came to no number, so it stays as configured",
                   verdict.effect);
      continue;
    }
    // What is configured stands unless the other is clearly better.
    verdict = FromTrial(verdict, with, without, is_on ? -kWorthIt : kWorthIt);
    if (verdict.on != is_on) {
      trial = other;
      as_it_is = {{steps, otherwise}};
    }
    trials.assignments.push_back(verdict.assignment);
    fmt::print("{}", RowOf(verdict));
  }
  trials.seconds = watch.Seconds();
  if (!has_begun) return trials;
  fmt::print("tried for {:.1f} s\n", trials.seconds);
  std::fflush(stdout);
  return trials;
}

}  // namespace nerf
