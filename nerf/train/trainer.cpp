#include "nerf/train/trainer.h"

#include <cmath>

#include "nerf/base/stopwatch.h"
#include "nerf/model/run_folder.h"
#include "nerf/train/metrics_file.h"
#include "nerf/train/trainer_state.h"
#include "nerf/train/training_display.h"
#include "nerf/train/visible_cells.h"

namespace nerf {

Trainer::Trainer(const Config& config, const SceneFacts& scene, const Dataset& data,
                 const std::filesystem::path& run, double spent)
    : state_(std::make_unique<State>(MakeModel(config, scene), data, run, spent)) {
  KeepVisibleCells(*state_->model.grid, data.train);
  if (state_->model.background) state_->StartBackground();
}

Trainer::Trainer(const Checkpoint& checkpoint, const Dataset& data,
                 const std::filesystem::path& run, double spent)
    : state_(std::make_unique<State>(ModelFromCheckpoint(checkpoint), data, run,
                                     spent + checkpoint.meta.value("spent_seconds", 0.0))) {
  state_->Load(checkpoint);
}

Trainer::~Trainer() = default;

const Model& Trainer::GetModel() const { return state_->model; }

double Trainer::ValidationPsnrAtOwnExposure() {
  return state_->validation.Psnr(state_->model, true);
}

double Trainer::TrySteps(int steps) {
  State& s = *state_;
  const Stopwatch watch;
  for (int i = 0; i < steps && !s.Over(); ++i) s.Step();
  return watch.Seconds() / steps;
}

TrainSummary Trainer::Run(const std::atomic<bool>& stop) {
  State& s = *state_;
  const TrainOptions& options = s.Options();
  MetricsFile metrics(MetricsPath(s.run), s.step);
  const bool timed = options.time_budget > 0;
  const auto done = [&] { return timed ? std::llround(s.pace.Spent()) : s.step; };
  TrainingDisplay display(timed ? std::llround(options.time_budget) : options.steps, done());

  // Asked for once a step, for the clock goes on.
  bool over = s.Over();
  while (!over && !stop) {
    const double before = s.training_seconds;
    const auto rays = static_cast<double>(s.rays_per_batch);
    const StepResult result = s.Step();
    over = s.Over();

    LapTimer timer;
    const bool validates = over || s.step % options.validate_every == 0;
    if (validates) {
      if (!s.validation.Empty())
        s.validation_psnr = s.validation.Psnr(s.model, s.model.exposure != nullptr);
      metrics.Append(s.Metrics());
      s.tally = {};
      over = over || s.ReachedTarget();
    }
    if (over || s.step % options.checkpoint_every == 0) {
      s.Save();
      double seconds = 0;
      timer.Lap(seconds);
      if (validates) s.pace.SetSecondsOfTheEnd(seconds);
    }
    display.Update(done(), result.loss, rays / (s.training_seconds - before), metrics.Curve());
  }
  if (!over) s.Save();
  return {over, s.step, s.training_seconds, s.validation_psnr, s.ReachedTarget(), metrics.Curve()};
}

}  // namespace nerf
