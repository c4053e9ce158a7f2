#include "nerf/pipeline/gaussian_training.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "nerf/base/stopwatch.h"
#include "nerf/pipeline/frame_limit.h"
#include "nerf/render/non_finite_error.h"

namespace nerf {
namespace {

constexpr int kValidations = 8;  // in a fit
// Before the last part of this many nothing is left out any more, so that the fit can recover.
constexpr int kFrameChecks = 32;

// How far a fit is, by iterations or by time.
class FitClock {
 public:
  //   spent  seconds, before
  FitClock(const GaussianPlan& plan, const SplatOptions& options, double spent)
      : options_(options), steps_(static_cast<double>(plan.steps)), spent_(spent) {
    if (plan.seconds > 0) seconds_ = spent + plan.seconds;
  }

  // The first iteration follows; preparing may have taken long.
  void Begin(std::int64_t step) {
    if (seconds_ > 0) seconds_ = std::max(seconds_, spent_ + watch_.Seconds() / kMostToPrepare);
    first_step_ = static_cast<double>(step);
    first_ = UnitsUntil(At(step).fraction);
  }

  double Seconds() const { return spent_ + watch_.Seconds(); }
  // Those of the whole fit; 0: it is by iterations.
  double PlannedSeconds() const { return seconds_; }
  // Keeps time for what follows the last iteration.
  void Reserve(double seconds) { reserved_ = std::max(reserved_, seconds); }

  FitProgress At(std::int64_t step) const {
    const auto taken = static_cast<double>(step);
    if (seconds_ == 0) return {std::min(1.0, taken / steps_), steps_};
    const double fraction = std::min(1.0, Seconds() / std::max(1e-3, seconds_ - reserved_));
    return {fraction, StepsOfAll(taken, UnitsUntil(fraction))};
  }

 private:
  static constexpr int kWarmUp = 20;
  static constexpr double kAssumedSteps = 2000;
  static constexpr double kMostToPrepare = 0.5;  // of the seconds of a fit

  // Iterations of the whole fit, if they go on as they did in this command.
  double StepsOfAll(double taken, double until) const {
    const double here = taken - first_step_;
    if (here >= kWarmUp) {
      return first_step_ + here * (UnitsUntil(1) - first_) / std::max(1e-9, until - first_);
    }
    if (first_step_ > 0) return first_step_ * UnitsUntil(1) / std::max(1e-9, first_);
    return kAssumedSteps;
  }

  // The share of iterations until then, in units of those at full resolution.
  double UnitsUntil(double fraction) const {
    // An iteration at lower resolution takes about so much of the time of another.
    constexpr double kQuarter = 0.25, kHalf = 0.4;
    const double quarter = options_.quarter_resolution;
    const double half = std::max(quarter, options_.half_resolution);
    return std::min(fraction, quarter) / kQuarter +
           std::clamp(fraction - quarter, 0.0, half - quarter) / kHalf +
           std::max(0.0, fraction - half);
  }

  const SplatOptions& options_;
  double steps_, spent_;
  double seconds_ = 0;  // of the whole fit; 0: it is by iterations
  double reserved_ = 0;
  double first_step_ = 0, first_ = 0;  // where this command began
  Stopwatch watch_;
};

[[noreturn]] void ThrowNotFinite(const GaussianFit& fit, const SplatOptions& options) {
  throw NonFiniteError(fmt::format(
      "the loss of iteration {} of the Gaussians is not finite; try smaller rates: --set "
      "splats.mean_rate={}",
      fit.Steps(), options.mean_rate / 3));
}

}  // namespace

GaussianResult FitGaussians(const GaussianScene& scene, GaussianStart start,
                            const GaussianValidation* validation, const GaussianPlan& plan,
                            const std::atomic<bool>& stop, const PipelineListener& listener) {
  FitClock clock(plan, scene.config.splats, start.made.seconds);
  GaussianFit fit(scene.train, scene.facts.has_alpha, std::move(start.state), scene.config.splats,
                  start.near, scene.config.train.seed);
  const std::int64_t first_step = fit.Steps();
  clock.Begin(first_step);
  GaussianSummary summary;
  const auto model = [&] {
    return GaussianModel(scene.config, scene.facts, fit.Cloud(), start.near,
                         {fit.Steps(), clock.Seconds(), start.made.field_step});
  };
  const auto validate = [&] {
    if (validation == nullptr || validation->Empty()) return;
    const Stopwatch watch;
    summary.psnr = validation->Psnr(fit.Cloud(), start.near);
    summary.reached_target = plan.target_psnr > 0 && summary.psnr >= plan.target_psnr;
    summary.curve.Add(clock.Seconds(), summary.psnr);
    clock.Reserve(watch.Seconds());
  };
  const auto write = [&](const InterruptedFit* interrupted) {
    if (plan.file.empty()) return;
    plan.before_writing();
    WriteGaussians(model(), plan.file, interrupted);
  };
  const auto save_to_resume = [&] {
    const InterruptedFit interrupted = {fit.State(), clock.PlannedSeconds(), plan.steps,
                                        plan.seconds_per_frame};
    write(&interrupted);
  };
  FitProgress progress = clock.At(fit.Steps());
  const auto part = [&] { return static_cast<int>(progress.fraction * kValidations); };
  const auto check = [&] { return static_cast<int>(progress.fraction * kFrameChecks); };
  while (progress.fraction < 1 && !summary.reached_target && !stop) {
    const int part_before = part(), check_before = check();
    const double loss = fit.Step(progress);
    if (!std::isfinite(loss)) ThrowNotFinite(fit, scene.config.splats);
    progress = clock.At(fit.Steps());
    if (part() > part_before && progress.fraction < 1) validate();
    if (plan.seconds_per_frame > 0 && check() > check_before && check() < kFrameChecks) {
      KeepToFrameTime(fit, scene.train, start.near, plan.seconds_per_frame);
    }
    if (plan.checkpoint_every > 0 && fit.Steps() % plan.checkpoint_every == 0) save_to_resume();
    listener(GaussiansStepped{fit.Steps(), progress.fraction, loss, summary.psnr});
  }
  summary.finished = progress.fraction >= 1 || summary.reached_target;
  if (summary.finished) {
    validate();
    write(nullptr);
  } else if (fit.Steps() > first_step) {  // else what is there stays
    save_to_resume();
  }
  summary.steps = fit.Steps();
  summary.gaussians = fit.Cloud().count;
  summary.seconds = clock.Seconds();
  if (plan.seconds_per_frame > 0) {
    summary.seconds_per_frame = SecondsPerFrame(fit.Cloud(), scene.train, start.near);
  }
  return {model(), summary};
}

std::optional<GaussianStart> StartAgain(const std::filesystem::path& file, GaussianPlan& plan) {
  std::optional<InterruptedFit> fit = ReadInterruptedFit(file);
  if (!fit) return std::nullopt;
  const GaussianModel model = ReadGaussians(file);
  plan.steps = fit->planned_steps;
  plan.seconds_per_frame = fit->seconds_per_frame;
  plan.seconds = fit->planned_seconds > 0
                     ? std::max(kLeastFitSeconds, fit->planned_seconds - model.Made().seconds)
                     : 0;
  return GaussianStart{std::move(fit->state), model.Near(), model.Made()};
}

}  // namespace nerf
