#include "nerf/pipeline/representation_training.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/temporary_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/representation_trial.h"
#include "nerf/render/non_finite_error.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

// When the trial takes place, and its length: shares of the training and of the time budget.
constexpr double kTrialAt = 0.12, kTrialShare = 0.03;
// Without a budget: of the iterations.
constexpr double kTrialStepShare = 0.2;
constexpr std::int64_t kFewestTrialSteps = 50;
// What follows the fit: the picture and files.
constexpr double kEndSeconds = 0.5;

// One training of both; `record_` is what RUN/representation.json has.
class Training {
 public:
  Training(Trainer& trainer, const Dataset& data, const fs::path& run,
           const std::atomic<bool>& stop, const PipelineListener& listener)
      : trainer_(trainer),
        data_(data),
        run_(run),
        stop_(stop),
        listener_(listener),
        options_(trainer.GetModel().config.train),
        splats_(trainer.GetModel().config.splats),
        budget_(RadianceSeconds(trainer.GetModel().config)),
        spent_(trainer.SpentSeconds()),
        record_(ReadRepresentation(run)) {}

  RepresentationsTrained Run() {
    if (HasBudget()) trainer_.EndAt(budget_);
    if (!record_.makes_splats && !Decide()) return Result(field_.finished);
    if (*record_.makes_splats && HasBudget()) {
      // Where it has ended in an earlier command, it has, whatever the clock says.
      const bool has_ended = record_.field_steps == trainer_.Steps();
      trainer_.EndAt(has_ended ? trainer_.SpentSeconds() : record_.field_seconds);
    }
    TrainField(1);
    if (field_.finished && *record_.makes_splats && record_.field_steps != field_.step) {
      record_.field_steps = field_.step;
      WriteRepresentation(record_, run_);
    }
    if (!field_.finished || field_.reached_target || !*record_.makes_splats) {
      return Result(field_.finished);
    }
    return Result(MakeSplatsOrKeepField());
  }

 private:
  // With the members as they are after `finished` was found.
  RepresentationsTrained Result(bool finished) const {
    return {field_, record_, finished, field_.reached_target || splats_reached_target_};
  }
  bool HasBudget() const { return budget_ > 0; }
  // Of what is left of the time budget when training begins.
  double Part(double share) const { return share * (budget_ - spent_); }
  // Of the Gaussians, planned; 0: they take iterations.
  double FitSeconds() const { return splats_.share * budget_; }
  std::int64_t SplatSteps() const { return std::min<std::int64_t>(splats_.steps, options_.steps); }

  void TrainField(double until) {
    const std::int64_t before = trainer_.Steps();
    field_ = trainer_.Run(
        stop_, [this](const TrainerEvent& event) { listener_(event); }, until);
    // What `nerf splat` made of the field, and compared with it, was made of an earlier one.
    if (field_.step == before || !(record_.reached || record_.splats_stand)) return;
    record_.ForgetReached();
    WriteRepresentation(record_, run_);
  }

  // Whether RUN/splats.nerf was made of the field as it is.
  bool HasItsSplats() const {
    return fs::exists(GaussiansPath(run_)) &&
           OpenGaussians(run_)->Made().field_step == trainer_.Steps();
  }

  // Trains the field up to the trial, and decides. False where training has ended before.
  bool Decide() {
    RepresentationDecided decided;
    if (options_.representation == Representation::kSplats) {
      if (const std::string why_not = WhyNoGaussians(trainer_.GetModel().config, data_);
          !why_not.empty()) {
        throw InputError("train.representation splats: {}; or use field", why_not);
      }
      decided.makes_splats = true;
    } else if (options_.representation == Representation::kAuto) {
      decided.why_not = WhyNoGaussians(trainer_.GetModel().config, data_);
      if (decided.why_not.empty() && !DecideByTrial(decided)) return false;
    }
    record_.makes_splats = decided.makes_splats;
    record_.tried = decided.tried;
    if (HasBudget() && decided.makes_splats) {
      record_.field_seconds =
          std::max(spent_ + Part(1 - splats_.share), trainer_.SpentSeconds() + Part(kTrialShare));
    }
    if (options_.representation == Representation::kField) return true;
    WriteRepresentation(record_, run_);
    listener_(decided);
    return true;
  }

  // False where training has ended, or was stopped, before.
  bool DecideByTrial(RepresentationDecided& decided) {
    TrainField(HasBudget() ? (spent_ + Part(kTrialAt)) / budget_ : kTrialAt);
    if (stop_) return false;
    if (field_.finished) {
      // With Gaussians the decision was there, and its file was lost.
      decided.makes_splats = !field_.reached_target && HasItsSplats();
      return decided.makes_splats;
    }
    const Trial trial = Try();
    if (stop_) {
      field_.finished = false;
      return false;
    }
    decided.tried = trial.psnr;
    decided.why_not = trial.why_not;
    decided.makes_splats = trial.psnr && SplatsPromiseMore(*trial.psnr);
    return true;
  }

  Trial Try() const {
    const auto steps =
        static_cast<std::int64_t>(kTrialStepShare * static_cast<double>(SplatSteps()));
    return TryGaussians(trainer_.GetModel(), data_, HasBudget() ? Part(kTrialShare) : 0,
                        std::max(kFewestTrialSteps, steps), stop_, listener_);
  }

  // The field is trained: where Gaussians were not asked for by name, it stands without them.
  bool MakeSplatsOrKeepField() {
    GaussianPlan plan;
    plan.steps = SplatSteps();
    std::optional<GaussianStart> again;
    const bool has_its = HasItsSplats();
    if (has_its) again = StartAgain(GaussiansPath(run_), plan);  // errors name the file
    try {
      if (has_its && !again) {
        RecordEndedBefore();
        return true;
      }
      return MakeSplats(std::move(again), plan);
    } catch (const InputError& error) {
      if (options_.representation == Representation::kSplats) throw;
      return KeepField(error);
    } catch (const NonFiniteError& error) {
      if (options_.representation == Representation::kSplats) throw;
      return KeepField(error);
    }
  }

  // Without Gaussians, in the time that was meant for them.
  bool KeepField(const std::exception& error) {
    listener_(GaussiansFailed{error.what()});
    if (HasItsSplats()) RemoveAll(GaussiansPath(run_));  // as far as the fit went
    record_.makes_splats = false;
    record_.field_seconds = 0;
    WriteRepresentation(record_, run_);
    if (HasBudget()) {
      trainer_.EndAt(budget_);
      TrainField(1);
    }
    return field_.finished;
  }

  //   psnr  of the Gaussians, dB; ignored where nothing validates
  void RecordEnd(const GaussianValidation& validation, double psnr) {
    if (validation.Empty()) {
      record_.splats_stand = true;
    } else {
      record_.reached = {field_.validation_psnr, psnr};
      splats_reached_target_ = options_.target_psnr > 0 && psnr >= options_.target_psnr;
    }
    WriteRepresentation(record_, run_);
  }

  // A fit that ended in an earlier command, maybe before it was compared.
  void RecordEndedBefore() {
    const GaussianScene scene = GaussianSceneOf(trainer_.GetModel(), data_, FitSeconds());
    const GaussianValidation validation(scene, data_);
    const auto model = OpenGaussians(run_);
    const double psnr = record_.reached      ? record_.reached->splats
                        : validation.Empty() ? 0
                                             : validation.Psnr(model->Cloud(), model->Near());
    RecordEnd(validation, psnr);
  }

  // False where it was stopped.
  //   again  where a fit was interrupted; its plan is in `plan`
  bool MakeSplats(std::optional<GaussianStart> again, GaussianPlan plan) {
    const GaussianScene scene = GaussianSceneOf(trainer_.GetModel(), data_, FitSeconds());
    const GaussianValidation validation(scene, data_);
    std::optional<GaussianStart> start = std::move(again);
    if (!start) {
      WarnOfFieldsEffects(scene.config, listener_);
      const auto field = ModelSnapshot::Copy(trainer_.GetModel(), trainer_.Steps());
      start = StartAtSurfaces(*field, scene, stop_, [&](std::size_t done) {
        listener_(SurfacesRendered{done, scene.train.size()});
      });
      if (!start) return false;
      if (HasBudget()) {
        const double left = budget_ - kEndSeconds - trainer_.SpentSeconds();
        plan.seconds = std::max(kLeastFitSeconds, left);
      }
    }
    plan.file = GaussiansPath(run_);
    plan.checkpoint_every = options_.checkpoint_every;
    plan.target_psnr = options_.target_psnr;
    const GaussianSummary fit =
        FitGaussians(scene, std::move(*start), &validation, plan, stop_, listener_).summary;
    if (fit.finished) RecordEnd(validation, fit.psnr);
    listener_(GaussiansEnded{fit, record_.reached});
    return fit.finished;
  }

  Trainer& trainer_;
  const Dataset& data_;
  const fs::path& run_;
  const std::atomic<bool>& stop_;
  const PipelineListener& listener_;
  const TrainOptions& options_;
  const SplatOptions& splats_;
  const double budget_;  // seconds; 0: none
  const double spent_;   // seconds, when training begins
  RepresentationRecord record_;
  TrainSummary field_;
  bool splats_reached_target_ = false;
};

}  // namespace

std::string WhyNoGaussians(const Config& config, const Dataset& data) {
  if (data.encoding == ColorEncoding::kLinear) {
    return "Gaussians are not fitted to linear photographs";
  }
  if (config.train.representation == Representation::kAuto && data.validation.empty()) {
    return "without validation photographs nothing can be compared";
  }
  return TooLittleMemory(
      SplatOptionsFor(config.splats, data, config.splats.share * RadianceSeconds(config)));
}

RepresentationsTrained TrainRepresentations(Trainer& trainer, const Dataset& data,
                                            const fs::path& run, const std::atomic<bool>& stop,
                                            const PipelineListener& listener) {
  return Training(trainer, data, run, stop, listener).Run();
}

}  // namespace nerf
