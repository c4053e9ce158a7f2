#include "nerf/train/trainer.h"

#include <algorithm>
#include <cmath>

#include "nerf/data/pixel_sampler.h"
#include "nerf/effects/background.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/field/tensor_span.h"
#include "nerf/parallel.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/stopwatch.h"
#include "nerf/train/checkpoint.h"
#include "nerf/train/engine.h"
#include "nerf/train/metrics_file.h"
#include "nerf/train/non_finite_error.h"
#include "nerf/train/optimizer.h"
#include "nerf/train/pace.h"
#include "nerf/train/parameters.h"
#include "nerf/train/run_folder.h"
#include "nerf/train/tally.h"
#include "nerf/train/training_display.h"
#include "nerf/train/validation.h"
#include "nerf/train/visible_cells.h"
#include "sfm/input_error.h"

namespace nerf {
namespace {

// What checkpoints call the state of the error map.
constexpr char kErrorsName[] = "sampler.errors";

}  // namespace

struct Trainer::State {
  State(Model model_in, const Dataset& data_in, std::filesystem::path run_in, double spent)
      : model(std::move(model_in)),
        data(data_in),
        run(std::move(run_in)),
        sampler(data.train, Options().error_driven_share,
                model.config.effects.depth ? model.config.effects.depth->share : 0.0),
        optimizer(NamedParameters(model), model.config.optimizer),
        validation(data.validation, Options().seed),
        pace(Options(), spent),
        rays_per_batch(std::clamp<std::int64_t>(Options().samples_per_batch / 128, 1,
                                                Options().max_rays_per_batch)) {
    TORCH_CHECK(Options().target_psnr == 0 || !validation.Empty(),
                "Trainer: a target PSNR needs validation photographs");
    if (model.exposure || model.poses) CheckPhotographs();
  }

  const TrainOptions& Options() const { return model.config.train; }

  void CheckPhotographs() const;
  void StartBackground();
  StepResult Step();
  StepResult Learn(StepSeconds& seconds);
  void AdaptBatch(std::int64_t shaded);
  bool ReachedTarget() const;
  // Not before the first step: a run without one has nothing to show.
  bool Over() const { return step > 0 && (ReachedTarget() || pace.Progress(step) >= 1); }
  nlohmann::json Metrics() const;
  void Save() const;

  Model model;
  const Dataset& data;
  std::filesystem::path run;
  PixelSampler sampler;
  Adam optimizer;
  Validation validation;
  Pace pace;
  Tally tally;  // since the last line of metrics

  // What a checkpoint keeps beside parameters and optimiser; random numbers need no more than
  // these.
  std::int64_t step = 0;
  std::int64_t rays_per_batch;
  double training_seconds = 0;
  double validation_psnr = 0;
};

// What is known of each photograph belongs to those that training began with, in their order.
void Trainer::State::CheckPhotographs() const {
  const std::vector<std::string>& names = model.scene.photographs;
  if (std::ranges::equal(names, data.train, {}, {}, &View::name)) return;
  throw sfm::InputError(
      "{}: was trained on {} photographs, and now there are {}, or others; put back what it was "
      "trained on, or train again",
      run.string(), names.size(), data.train.size());
}

void Trainer::State::StartBackground() {
  constexpr std::int64_t kRaysOfATexel = 32;
  const std::int64_t rows = model.config.effects.background->resolution;
  const TargetBatch batch =
      PixelSampler(data.train).Sample(2 * rows * rows * kRaysOfATexel, Options().seed, 0);
  model.background->Start(batch);
}

// A step with its book-keeping.
StepResult Trainer::State::Step() {
  StepSeconds seconds;
  LapTimer timer;
  const std::int64_t rays = rays_per_batch;
  const StepResult result = Learn(seconds);
  AdaptBatch(result.shaded);
  ++step;
  timer.Lap(seconds.all);
  training_seconds += seconds.all;
  tally.Add(result, rays, seconds);
  return result;
}

StepResult Trainer::State::Learn(StepSeconds& seconds) {
  const TrainOptions& options = Options();
  if (model.proposal) {
    const int anneal = model.config.proposal.anneal_steps;
    model.proposal->SetTrust(anneal > 0 ? static_cast<double>(step) / anneal : 1.0);
  } else if (const int fade = model.config.occupancy.coarse_to_fine_steps; fade > 0) {
    model.field->SetDetail(static_cast<double>(step) / fade);
  }
  try {
    LapTimer timer;
    double of_engine = 0;
    if (step % model.config.occupancy.update_every == 0) {
      model.engine->UpdateOccupancy(step, options.seed);
    }
    timer.Lap(seconds.occupancy);
    model.engine->SetProgress(pace.Progress(step));
    const TargetBatch batch = sampler.Sample(rays_per_batch, options.seed, step);
    timer.Lap(seconds.pixels);
    const StepResult result = model.engine->AccumulateGradients(batch);
    timer.Lap(of_engine);
    if (ErrorMap* errors = sampler.Errors()) errors->Learn(batch.cell, result.ray_error);
    timer.Lap(seconds.pixels);
    optimizer.SetLearningRateFactor(
        LearningRateFactor(model.config.schedule, step, pace.Progress(step)));
    optimizer.step();
    timer.Lap(seconds.optimizer);
    return result;
  } catch (const NonFiniteError& error) {
    throw NonFiniteError(fmt::format("step {}: {}; the last good checkpoint stays in {}", step,
                                     error.what(), run.string()));
  }
}

// As the grid becomes tight a ray needs fewer samples, and a batch holds more rays.
void Trainer::State::AdaptBatch(std::int64_t shaded) {
  const double ratio = static_cast<double>(Options().samples_per_batch) /
                       static_cast<double>(std::max<std::int64_t>(1, shaded));
  const double wanted = static_cast<double>(rays_per_batch) * std::clamp(ratio, 0.5, 2.0);
  rays_per_batch = std::clamp<std::int64_t>(std::llround(wanted), 1, Options().max_rays_per_batch);
}

bool Trainer::State::ReachedTarget() const {
  return Options().target_psnr > 0 && validation_psnr >= Options().target_psnr;
}

nlohmann::json Trainer::State::Metrics() const {
  nlohmann::json line = tally.Metrics();
  line["step"] = step;
  line["seconds"] = training_seconds;
  line["spent_seconds"] = pace.Spent();
  line["occupied"] = model.grid->OccupiedFraction();
  line["learning_rate"] = model.config.optimizer.learning_rate *
                          LearningRateFactor(model.config.schedule, step, pace.Progress(step));
  if (!validation.Empty()) line["validation_psnr"] = validation_psnr;
  return line;
}

void Trainer::State::Save() const {
  Checkpoint checkpoint;
  AddModel(model, checkpoint);
  optimizer.AddTo(checkpoint.tensors);
  if (const ErrorMap* errors = sampler.Errors()) {
    const std::vector<float> cells(errors->Errors().begin(), errors->Errors().end());
    checkpoint.tensors[kErrorsName] =
        TensorOf(cells, {static_cast<std::int64_t>(cells.size())}, torch::kFloat).clone();
  }
  checkpoint.meta["step"] = step;
  checkpoint.meta["rays_per_batch"] = rays_per_batch;
  checkpoint.meta["training_seconds"] = training_seconds;
  checkpoint.meta["spent_seconds"] = pace.Spent();
  checkpoint.meta["threads"] = NumThreads();
  checkpoint.meta["validation_psnr"] = validation_psnr;
  WriteCheckpoint(CheckpointPath(run), checkpoint);
}

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
  try {
    state_->optimizer.LoadFrom(checkpoint.tensors);
    if (ErrorMap* errors = state_->sampler.Errors()) {
      std::vector<float> kept(errors->Errors().size());
      CopyTensor(checkpoint.tensors, kErrorsName,
                 torch::from_blob(kept.data(), {static_cast<std::int64_t>(kept.size())}));
      errors->SetErrors(kept);
    }
    state_->step = checkpoint.meta.at("step");
    state_->rays_per_batch = checkpoint.meta.at("rays_per_batch");
    state_->training_seconds = checkpoint.meta.at("training_seconds");
    state_->validation_psnr = checkpoint.meta.at("validation_psnr");
    const TrainOptions& options = state_->Options();
    if (state_->step < 0 || state_->rays_per_batch < 1 ||
        state_->rays_per_batch > options.max_rays_per_batch) {
      throw sfm::InputError("{}: step or rays_per_batch are out of range; train again",
                            CheckpointPath(run).string());
    }
  } catch (const nlohmann::json::exception& error) {
    throw sfm::InputError("{}: {}; train again", CheckpointPath(run).string(), error.what());
  }
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
