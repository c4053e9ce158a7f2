#include "nerf/commands/effects_trials.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>

#include "nerf/stopwatch.h"
#include "nerf/train/effect_trial.h"
#include "nerf/train/held_out.h"

namespace nerf {
namespace {

// What a short training can tell: the others are facts, need what is not at hand, or (poses) cannot
// be judged by photographs whose own poses are not refined.
const std::set<std::string> kTried = {"exposure", "view", "robust", "footprint"};
constexpr int kSteps = 200;
constexpr std::int64_t kSamples = 16384;   // a step
constexpr double kWorthIt = 0.2;           // dB, more than the noise of a trial
constexpr double kShare = 0.15;            // of the training, that trials may take
constexpr std::size_t kFewestHeldOut = 2;  // on one photograph a difference is chance

// Where nothing tells at all, exposure alone is tried: photographs often differ in it, and it may
// be worth ten decibels.
bool IsOpen(const Verdict& verdict, const std::set<std::string>& named) {
  if (verdict.IsSure() || named.contains(verdict.effect)) return false;
  return verdict.decided ? kTried.contains(verdict.effect) : verdict.effect == "exposure";
}

// How long trials may go on: by the clock where a training ends by it, else by their number.
class Allowance {
 public:
  Allowance(const TrainOptions& options, double seconds_left)
      : seconds_(options.time_budget > 0 ? kShare * seconds_left
                                         : std::numeric_limits<double>::infinity()),
        trainings_(options.time_budget > 0 ? std::numeric_limits<double>::infinity()
                                           : kShare * static_cast<double>(options.steps) *
                                                 static_cast<double>(options.samples_per_batch) /
                                                 (static_cast<double>(kSteps) * kSamples)) {}
  // Whether so many trainings more fit, by what those before have taken; the first by a guess.
  bool Has(int more) const {
    constexpr double kGuess = 4;  // seconds
    const double each = done_ > 0 ? watch_.Seconds() / done_ : kGuess;
    return done_ + more <= trainings_ && watch_.Seconds() + more * each <= seconds_;
  }
  void Count() { ++done_; }
  double Seconds() const { return watch_.Seconds(); }

 private:
  double seconds_, trainings_;
  int done_ = 0;
  Stopwatch watch_;
};

}  // namespace

EffectTrials TryWhatIsOpen(const Config& config, const SceneFacts& scene,
                           const std::set<std::string>& named, double seconds_left, Dataset& data,
                           std::vector<Verdict>& verdicts) {
  EffectTrials trials;
  Allowance allowance(config.train, seconds_left);
  const HeldOut held_out(data, scene);
  if (data.validation.size() < kFewestHeldOut) return trials;
  Config trial = config;
  trial.train.samples_per_batch = kSamples;
  const auto psnr_of = [&](const Config& tried) {
    const double psnr = TryConfig(tried, held_out.Scene(), data, kSteps).psnr;
    allowance.Count();
    return psnr;
  };
  std::optional<double> as_it_is;  // the PSNR of `trial`
  for (Verdict& verdict : verdicts) {
    if (!IsOpen(verdict, named) || !allowance.Has(as_it_is ? 1 : 2)) continue;
    const bool is_on = Simulates(trial, verdict.effect);
    const Config other = WithEffect(trial, verdict.effect, is_on ? "null" : "{}");
    if (!as_it_is) as_it_is = psnr_of(trial);
    const double otherwise = psnr_of(other);
    const double with = is_on ? *as_it_is : otherwise, without = is_on ? otherwise : *as_it_is;
    // What is configured stands unless the other is clearly better.
    verdict = Tried(verdict, with, without, is_on ? -kWorthIt : kWorthIt);
    if (verdict.on != is_on) {
      trial = other;
      as_it_is = otherwise;
    }
    trials.assignments.push_back(verdict.assignment);
    fmt::print("{}", RowOf(verdict));
  }
  if (!as_it_is) return trials;
  trials.seconds = allowance.Seconds();
  fmt::print("tried for {:.1f} s\n", trials.seconds);
  std::fflush(stdout);
  return trials;
}

}  // namespace nerf
