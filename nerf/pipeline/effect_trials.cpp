#include "nerf/pipeline/effect_trials.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>
#include <map>

#include "nerf/base/stopwatch.h"
#include "nerf/pipeline/held_out_halves.h"
#include "nerf/pipeline/short_training.h"
#include "nerf/pipeline/trial_allowance.h"
#include "nerf/render/non_finite_error.h"

namespace nerf {
namespace {

constexpr std::int64_t kSamples = 16384;  // per step
constexpr double kGain = 0.2;             // dB, more than the noise of a trial
// The share of the training that trials may take: with inconclusive evidence, and with none, where
// trials rarely change anything. While quality rises quickly (the chair in its first minutes), a
// twentieth of the time is worth a tenth of a decibel.
constexpr double kShare = 1.0 / 7, kShareWithoutEvidence = 1.0 / 20;
constexpr double kFastestStep = 0.01;      // seconds, assumed before a step was timed
constexpr std::size_t kFewestHeldOut = 2;  // a difference on one photograph is not significant

// As TrainShortly, with a PSNR of minus infinity if training diverges.
ShortTraining TrainShortlyOrDiverge(const Config& config, const SceneFacts& scene,
                                    const Dataset& data, int steps) {
  try {
    return TrainShortly(config, scene, data, steps);
  } catch (const NonFiniteError&) {
    ShortTraining diverged;
    diverged.psnr = -std::numeric_limits<double>::infinity();
    return diverged;
  }
}

// Estimated seconds per step; 0 if training diverges, which the trial will report.
double EstimateOrZero(const Config& config, const SceneFacts& scene, const Dataset& data,
                      int steps) {
  try {
    return EstimateSecondsPerStep(config, scene, data, steps);
  } catch (const NonFiniteError&) {
    return 0;
  }
}

// The trials of one capture. `best_` is the configuration with the decisions so far.
class Trials {
 public:
  Trials(const Config& config, const SceneFacts& scene, double seconds_left, const Dataset& data)
      : scene_(scene),
        data_(data),
        allowance_(config.train, seconds_left, kSamples),
        best_(config) {
    best_.train.samples_per_batch = kSamples;
  }

  // Whether there is time for the trials of a verdict.
  bool HasTimeFor(const EffectDescriptor& effect, bool has_evidence) {
    const int steps = effect.trial_steps;
    const int needed = psnr_of_best_.contains(steps) ? steps : 2 * steps;
    const auto fits = [&](double seconds_per_step) {
      return allowance_.Allows(needed, seconds_per_step,
                               has_evidence ? kShare : kShareWithoutEvidence, watch_.Seconds());
    };
    if (!fits(seconds_per_step_ == 0 ? kFastestStep : seconds_per_step_)) return false;
    if (seconds_per_step_ > 0 || !allowance_.UsesClock()) return true;
    seconds_per_step_ = EstimateOrZero(best_, scene_, data_, steps);
    return fits(seconds_per_step_);
  }

  struct Result {
    bool was_on = false;
    double with = 0, without = 0;  // dB
  };
  Result Compare(const EffectDescriptor& effect) {
    const int steps = effect.trial_steps;
    Result result;
    result.was_on = Simulates(best_.effects, effect);
    alternative_ = WithEffect(best_, effect, !result.was_on);
    if (!psnr_of_best_.contains(steps)) psnr_of_best_[steps] = PsnrOf(best_, steps);
    psnr_of_alternative_ = PsnrOf(alternative_, steps);
    result.with = result.was_on ? psnr_of_best_[steps] : psnr_of_alternative_;
    result.without = result.was_on ? psnr_of_alternative_ : psnr_of_best_[steps];
    return result;
  }
  // Makes the alternative of the last Compare the best configuration.
  void AcceptAlternative(const EffectDescriptor& effect) {
    best_ = alternative_;
    psnr_of_best_ = {{effect.trial_steps, psnr_of_alternative_}};
  }

  double Seconds() const { return watch_.Seconds(); }

 private:
  double PsnrOf(const Config& config, int steps) {
    allowance_.Count(steps);
    const ShortTraining result = TrainShortlyOrDiverge(config, scene_, data_, steps);
    if (result.seconds > 0) seconds_per_step_ = result.seconds / steps;
    return result.psnr;
  }

  const SceneFacts& scene_;
  const Dataset& data_;
  const Stopwatch watch_;
  TrialAllowance allowance_;
  Config best_, alternative_;
  double psnr_of_alternative_ = 0;
  double seconds_per_step_ = 0;         // 0: not measured yet
  std::map<int, double> psnr_of_best_;  // by number of steps
};

}  // namespace

bool ShouldTry(const Verdict& verdict, const std::set<std::string>& requested) {
  if (verdict.IsConclusive() || requested.contains(verdict.effect)) return false;
  const EffectDescriptor* const effect = FindEffect(verdict.effect);
  return verdict.decided || (effect != nullptr && effect->tried_without_evidence);
}

EffectTrials RunEffectTrials(const Config& config, const SceneFacts& scene,
                             const std::set<std::string>& requested, double seconds_left,
                             Dataset& data, std::vector<Verdict>& verdicts,
                             const PipelineListener& listener) {
  EffectTrials result;
  const HeldOutHalves held_out(data);
  if (held_out.Count() < kFewestHeldOut) return result;
  Trials trials(config, scene, seconds_left, data);
  bool has_begun = false;
  for (Verdict& verdict : verdicts) {
    const EffectDescriptor* const effect = FindEffect(verdict.effect);
    if (effect == nullptr || !ShouldTry(verdict, requested)) continue;
    if (!trials.HasTimeFor(*effect, verdict.decided)) continue;
    has_begun = true;
    const auto [was_on, with, without] = trials.Compare(*effect);
    if (!std::isfinite(with - without)) {
      listener(Warning{fmt::format(
          "effects: a trial of {} diverged, so the effect stays as configured", verdict.effect)});
      continue;
    }
    // The configured setting is kept unless the alternative is clearly better.
    verdict = FromTrial(verdict, with, without, was_on ? -kGain : kGain);
    if (verdict.on != was_on) trials.AcceptAlternative(*effect);
    result.assignments.push_back(verdict.assignment);
    listener(VerdictReached{verdict});
  }
  result.seconds = trials.Seconds();
  if (has_begun) listener(EffectsTried{result.seconds});
  return result;
}

}  // namespace nerf
