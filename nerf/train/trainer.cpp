#include "nerf/train/trainer.h"

#include "nerf/base/stopwatch.h"
#include "nerf/model/run_folder.h"
#include "nerf/train/metrics_file.h"
#include "nerf/train/trainer_state.h"
#include "nerf/train/visible_cells.h"

namespace nerf {

Trainer::Trainer(const Config& config, const SceneFacts& scene, const Dataset& data,
                 const std::filesystem::path& run, double spent_seconds)
    : state_(std::make_unique<State>(MakeModel(config, scene), data, run, spent_seconds)) {
  KeepVisibleCells(*state_->model.grid, data.train);
  if (state_->model.background) state_->InitializeBackground();
}

Trainer::Trainer(const Checkpoint& checkpoint, const Dataset& data,
                 const std::filesystem::path& run, double spent_seconds)
    : state_(std::make_unique<State>(ModelFromCheckpoint(checkpoint), data, run,
                                     spent_seconds + checkpoint.meta.value("spent_seconds", 0.0))) {
  state_->Load(checkpoint);
}

Trainer::~Trainer() = default;

const Model& Trainer::GetModel() const { return state_->model; }

const std::shared_ptr<SnapshotSlot>& Trainer::Snapshots() const { return state_->snapshots; }

double Trainer::ValidationPsnrAtOwnExposure() const {
  return state_->validation.Psnr(state_->model, true);
}

double Trainer::TakeSteps(int steps) {
  const Stopwatch watch;
  int taken = 0;
  for (; taken < steps && !state_->Finished(); ++taken) state_->Step();
  return taken > 0 ? watch.Seconds() / taken : 0;
}

void Trainer::EndAt(double seconds) { state_->progress.EndAt(seconds); }

std::int64_t Trainer::Steps() const { return state_->step; }

double Trainer::SpentSeconds() const { return state_->progress.SpentSeconds(); }

TrainSummary Trainer::Run(const std::atomic<bool>& stop, const TrainerListener& listener,
                          double until) {
  State& s = *state_;
  const TrainOptions& options = s.Options();
  const auto report = [&](const TrainerEvent& event) {
    if (listener) listener(event);
  };
  MetricsFile metrics(MetricsPath(s.run), s.step);

  // Evaluated once per step, because it depends on the clock.
  bool finished = s.Finished();
  while (!finished && !stop && (until >= 1 || s.progress.Fraction(s.step) < until)) {
    const double before = s.training_seconds;
    const auto rays = static_cast<double>(s.rays_per_batch);
    const StepResult result = s.Step();
    finished = s.Finished();
    if (s.snapshots->IsRequested()) s.snapshots->Publish(ModelSnapshot::Copy(s.model, s.step));

    LapTimer timer;
    const bool validates = finished || s.step % options.validate_every == 0;
    if (validates) {
      if (!s.validation.Empty()) {
        s.validation_psnr = s.validation.Psnr(s.model, s.model.exposure != nullptr);
        report(Validated{s.step, s.training_seconds, s.validation_psnr});
      }
      metrics.Append(s.Metrics());
      s.statistics = {};
      finished = finished || s.ReachedTarget();
    }
    if (finished || s.step % options.checkpoint_every == 0) {
      s.Save();
      double seconds = 0;
      timer.Lap(seconds);
      if (validates) s.progress.ReserveSeconds(seconds);
      report(CheckpointWritten{s.step});
    }
    report(StepTaken{s.step, s.progress.SpentSeconds(), result.loss,
                     rays / (s.training_seconds - before), &metrics.Curve()});
  }
  if (!finished) s.Save();
  // For viewers that stay: nothing will answer their requests any more.
  if (s.snapshots->WasUsed()) s.snapshots->Publish(ModelSnapshot::Copy(s.model, s.step));
  return {finished,          s.step,         s.training_seconds, s.validation_psnr,
          s.ReachedTarget(), metrics.Curve()};
}

}  // namespace nerf
