#include "nerf/pipeline/representation_training.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "nerf/base/input_error.h"
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
        spent_(trainer.SpentSeconds()),
        record_(ReadRepresentation(run)) {}

  RepresentationsTrained Run() {
    if (!record_.makes_splats && !Decide()) return Result(field_.finished);
    if (*record_.makes_splats && HasBudget()) trainer_.EndAt(record_.field_seconds);
    TrainField(1);
    if (!field_.finished || field_.reached_target || !*record_.makes_splats) {
      return Result(field_.finished);
    }
    return Result(MakeSplatsOrWarn());
  }

 private:
  // With the members as they are after `finished` was found.
  RepresentationsTrained Result(bool finished) const {
    return {field_, record_, finished, field_.reached_target || splats_reached_target_};
  }
  bool HasBudget() const { return options_.time_budget > 0; }
  // Of what is left of the time budget when training begins.
  double Part(double share) const { return share * (options_.time_budget - spent_); }
  std::int64_t SplatSteps() const { return std::min<std::int64_t>(splats_.steps, options_.steps); }

  void TrainField(double until) {
    field_ = trainer_.Run(
        stop_, [this](const TrainerEvent& event) { listener_(event); }, until);
  }

  // Why no Gaussians can be made; empty: they can.
  std::string WhyNot() const {
    if (data_.encoding == ColorEncoding::kLinear) {
      return "Gaussians are not fitted to linear photographs";
    }
    if (options_.representation == Representation::kAuto && data_.validation.empty()) {
      return "without validation photographs nothing can be compared";
    }
    return "";
  }

  // Trains the field up to the trial, and decides. False where training has ended before.
  bool Decide() {
    RepresentationDecided decided;
    if (options_.representation == Representation::kSplats) {
      if (const std::string why_not = WhyNot(); !why_not.empty()) {
        throw InputError("train.representation splats: {}; use field", why_not);
      }
      decided.makes_splats = true;
    } else if (options_.representation == Representation::kAuto) {
      decided.why_not = WhyNot();
      if (decided.why_not.empty()) {
        TrainField(HasBudget() ? (spent_ + Part(kTrialAt)) / options_.time_budget : kTrialAt);
        if (field_.finished || stop_) return false;
        decided.tried = Try();
        if (stop_) {
          field_.finished = false;
          return false;
        }
        if (!decided.tried) decided.why_not = "the field has no surfaces yet to begin at";
        decided.makes_splats = decided.tried && SplatsPromiseMore(*decided.tried);
      }
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

  std::optional<ComparedPsnr> Try() const {
    const auto steps =
        static_cast<std::int64_t>(kTrialStepShare * static_cast<double>(SplatSteps()));
    return TryGaussians(trainer_.GetModel(), data_, HasBudget() ? Part(kTrialShare) : 0,
                        std::max(kFewestTrialSteps, steps), stop_, listener_);
  }

  // Where the fit begins, or goes on; nullopt where it has ended before.
  std::optional<GaussianStart> Start(const GaussianScene& scene, double& seconds_before) const {
    if (!fs::exists(GaussiansPath(run_))) {
      const auto field = ModelSnapshot::Copy(trainer_.GetModel(), field_.step);
      return StartAtSurfaces(*field, scene, [&](std::size_t done) {
        listener_(SurfacesRendered{done, scene.train.size()});
      });
    }
    const auto interrupted = ReadInterruptedFit(GaussiansPath(run_));
    if (!interrupted) return std::nullopt;
    seconds_before = interrupted->seconds;
    return GaussianStart{interrupted->state, OpenGaussians(run_)->Near()};
  }

  // The field is trained: where Gaussians were not asked for by name, it stands without them.
  bool MakeSplatsOrWarn() {
    const bool is_asked_for = options_.representation == Representation::kSplats;
    const auto keep_field = [&](const std::exception& error) {
      listener_(Warning{fmt::format("no Gaussians, the field is kept: {}", error.what())});
      record_.makes_splats = false;
      WriteRepresentation(record_, run_);
      return true;
    };
    try {
      return MakeSplats();
    } catch (const InputError& error) {
      if (is_asked_for || fs::exists(GaussiansPath(run_))) throw;
      return keep_field(error);
    } catch (const NonFiniteError& error) {
      if (is_asked_for) throw;
      return keep_field(error);
    }
  }

  void Compare(double splats_psnr) {
    record_.reached = {field_.validation_psnr, splats_psnr};
    WriteRepresentation(record_, run_);
  }

  // False where it was stopped.
  bool MakeSplats() {
    const GaussianScene scene = GaussianSceneOf(trainer_.GetModel(), data_);
    const GaussianValidation validation(scene, data_);
    double seconds_before = 0;
    std::optional<GaussianStart> start = Start(scene, seconds_before);
    if (!start) {  // it ended, but was interrupted before it was compared
      const auto model = OpenGaussians(run_);
      if (!record_.reached && !validation.Empty()) {
        Compare(validation.Psnr(model->Cloud(), model->Near()));
      }
      return true;
    }
    GaussianPlan plan;
    plan.steps = SplatSteps();
    plan.file = GaussiansPath(run_);
    plan.checkpoint_every = options_.checkpoint_every;
    plan.target_psnr = options_.target_psnr;
    if (HasBudget()) {
      const double left =
          options_.time_budget - kEndSeconds - seconds_before - trainer_.SpentSeconds();
      plan.seconds = std::max(1.0, left);
    }
    const GaussianSummary fit =
        FitGaussians(scene, std::move(*start), seconds_before, &validation, plan, stop_, listener_)
            .summary;
    if (fit.finished && !validation.Empty()) Compare(fit.psnr);
    splats_reached_target_ = fit.reached_target;
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
  const double spent_;  // seconds, when training begins
  RepresentationRecord record_;
  TrainSummary field_;
  bool splats_reached_target_ = false;
};

}  // namespace

RepresentationsTrained TrainRepresentations(Trainer& trainer, const Dataset& data,
                                            const fs::path& run, const std::atomic<bool>& stop,
                                            const PipelineListener& listener) {
  return Training(trainer, data, run, stop, listener).Run();
}

}  // namespace nerf
