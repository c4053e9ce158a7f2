#include "nerf/commands/effects_trials.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>

#include "nerf/stopwatch.h"
#include "nerf/train/effect_trial.h"
#include "nerf/train/held_out.h"
#include "nerf/train/non_finite_error.h"

namespace nerf {
namespace {

constexpr std::int64_t kSamples = 16384;   // a step
constexpr double kWorthIt = 0.2;           // dB, more than the noise of a trial
// Of the training, that trials may take: where the evidence is in between, and where there is none
// and they are most often for nothing. While a field learns fast, as the chair in its first minutes,
// a twentieth of the time is a tenth of a decibel.
constexpr double kShare = 1.0 / 7, kShareUnasked = 1.0 / 20;
constexpr double kFastest = 0.005;         // seconds of a step, while no more is known
constexpr std::size_t kFewestHeldOut = 2;  // on one photograph a difference is chance

// Steps of a trial. Poses must be found before they are worth anything.
int StepsOf(const std::string& effect) { return effect == "poses" ? 400 : 200; }

// How long trials may go on: by the clock where a training ends by it, else by their steps.
class Allowance {
 public:
  Allowance(const TrainOptions& options, double seconds_left)
      : seconds_left_(options.time_budget > 0 ? seconds_left
                                              : std::numeric_limits<double>::infinity()),
        steps_(options.time_budget > 0 ? std::numeric_limits<double>::infinity()
                                       : static_cast<double>(options.steps) *
                                             static_cast<double>(options.samples_per_batch) /
                                             kSamples) {}
  // Whether so many steps more fit into a share of the training.
  bool Has(int more, double seconds_a_step, double share) const {
    return done_ + more <= share * steps_ &&
           watch_.Seconds() + more * seconds_a_step <= share / (1 + share) * seconds_left_;
  }
  void Count(int steps) { done_ += steps; }
  bool IsByTheClock() const { return std::isfinite(seconds_left_); }
  double Seconds() const { return watch_.Seconds(); }

 private:
  double seconds_left_, steps_;  // of the training
  int done_ = 0;
  Stopwatch watch_;
};

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

// By its first steps; 0 where they come to no number, which the trial will find out, too.
double SecondsOfItsSteps(const Config& trial, const SceneFacts& scene, const Dataset& data,
                         int steps) {
  try {
    return SecondsOfAStep(trial, scene, data, steps);
  } catch (const NonFiniteError&) {
    return 0;
  }
}

}  // namespace

bool IsOpen(const Verdict& verdict, const std::set<std::string>& named) {
  if (verdict.IsSure() || named.contains(verdict.effect)) return false;
  return verdict.decided || verdict.effect == "exposure";
}

EffectTrials TryWhatIsOpen(const Config& config, const SceneFacts& scene,
                           const std::set<std::string>& named, double seconds_left, Dataset& data,
                           std::vector<Verdict>& verdicts) {
  EffectTrials trials;
  Allowance allowance(config.train, seconds_left);
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
    if (!allowance.Has(needed, std::max(seconds_a_step, kFastest), share)) continue;
    has_begun = true;
    if (seconds_a_step == 0 && allowance.IsByTheClock()) {
      seconds_a_step = SecondsOfItsSteps(trial, scene, data, steps);
      if (!allowance.Has(needed, seconds_a_step, share)) continue;
    }
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
    verdict = Tried(verdict, with, without, is_on ? -kWorthIt : kWorthIt);
    if (verdict.on != is_on) {
      trial = other;
      as_it_is = {{steps, otherwise}};
    }
    trials.assignments.push_back(verdict.assignment);
    fmt::print("{}", RowOf(verdict));
  }
  if (!has_begun) return trials;
  trials.seconds = allowance.Seconds();
  fmt::print("tried for {:.1f} s\n", trials.seconds);
  std::fflush(stdout);
  return trials;
}

}  // namespace nerf
