#include "nerf/train/trainer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>

#include "nerf/data/pixel_sampler.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/field/tensor_span.h"
#include "nerf/parallel.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/train/checkpoint.h"
#include "nerf/train/engine.h"
#include "nerf/train/non_finite_error.h"
#include "nerf/train/optimizer.h"
#include "nerf/train/parameters.h"
#include "nerf/train/run_folder.h"
#include "nerf/train/visible_cells.h"
#include "sfm/atomic_file.h"
#include "sfm/input_error.h"
#include "sfm/progress.h"

namespace nerf {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// What checkpoints call the state of the error map.
constexpr char kErrorsName[] = "sampler.errors";

double Psnr(double mean_squared_error) { return -10.0 * std::log10(mean_squared_error); }

// Metrics of the steps up to and with `last_step`: what a run wrote after the checkpoint it resumes
// from will be written again.
std::string MetricsUntil(const std::filesystem::path& path, std::int64_t last_step) {
  std::ifstream file(path);
  std::string kept;
  for (std::string line; std::getline(file, line);) {
    const auto json = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (json.is_object() && json.value("step", last_step + 1) <= last_step) kept += line + "\n";
  }
  return kept;
}

}  // namespace

// The running totals between two lines of metrics.
struct Tally {
  double loss = 0, squared_error = 0;
  std::int64_t steps = 0, rays = 0, marched = 0, shaded = 0;
  double seconds = 0;

  void Add(const StepResult& result, std::int64_t batch_rays, double step_seconds) {
    loss += result.loss;
    squared_error += result.squared_error;
    ++steps;
    rays += batch_rays;
    marched += result.marched;
    shaded += result.shaded;
    seconds += step_seconds;
  }
};

struct Trainer::State {
  State(Model model_in, const Dataset& data_in, std::filesystem::path run_in)
      : model(std::move(model_in)),
        data(data_in),
        run(std::move(run_in)),
        sampler(data.train, Options().error_driven_share),
        optimizer(NamedParameters(model), model.config.optimizer),
        rays_per_batch(std::clamp<std::int64_t>(Options().samples_per_batch / 128, 1,
                                                Options().max_rays_per_batch)) {
    if (!data.validation.empty()) {
      constexpr std::int64_t kValidationRays = 8192;
      validation = PixelSampler(data.validation).Sample(kValidationRays, Options().seed, 0);
      std::ranges::fill(validation.rays.jitter, 0.5f);
    }
  }

  const TrainOptions& Options() const { return model.config.train; }

  StepResult Step();
  void AdaptBatch(std::int64_t shaded);
  double Validate();
  void WriteMetrics(std::ofstream& file, const Tally& tally) const;
  void Save() const;

  Model model;
  const Dataset& data;
  std::filesystem::path run;
  PixelSampler sampler;
  Adam optimizer;
  TargetBatch validation;

  // What a checkpoint keeps beside parameters and optimiser; random numbers need no more than
  // these.
  std::int64_t step = 0;
  std::int64_t rays_per_batch;
  double training_seconds = 0;
  double validation_psnr = 0;
};

StepResult Trainer::State::Step() {
  const TrainOptions& options = Options();
  if (model.proposal) {
    const int anneal = model.config.proposal.anneal_steps;
    model.proposal->SetTrust(anneal > 0 ? static_cast<double>(step) / anneal : 1.0);
  } else if (const int fade = model.config.occupancy.coarse_to_fine_steps; fade > 0) {
    model.field->SetDetail(static_cast<double>(step) / fade);
  }
  try {
    if (step % model.config.occupancy.update_every == 0) {
      model.engine->UpdateOccupancy(step, options.seed);
    }
    const TargetBatch batch = sampler.Sample(rays_per_batch, options.seed, step);
    const StepResult result = model.engine->AccumulateGradients(batch);
    if (ErrorMap* errors = sampler.Errors()) errors->Learn(batch.cell, result.ray_error);
    optimizer.SetLearningRateFactor(LearningRateFactor(model.config.schedule, step, options.steps));
    optimizer.step();
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

double Trainer::State::Validate() {
  const RenderOutput out = model.engine->Render(validation.rays);
  double sum = 0;
  for (std::size_t i = 0; i < out.rgb.size(); ++i) {
    const double error =
        std::clamp(out.rgb[i], 0.0f, 1.0f) - std::clamp(validation.rgb[i], 0.0f, 1.0f);
    sum += error * error;
  }
  return Psnr(sum / static_cast<double>(out.rgb.size()));
}

void Trainer::State::WriteMetrics(std::ofstream& file, const Tally& tally) const {
  const auto steps = static_cast<double>(tally.steps);
  const auto rays = static_cast<double>(tally.rays);
  nlohmann::json line = {
      {"step", step},
      {"seconds", training_seconds},
      {"loss", tally.loss / steps},
      {"train_psnr", Psnr(tally.squared_error / steps)},
      {"rays_per_second", rays / tally.seconds},
      {"samples_per_second", static_cast<double>(tally.shaded) / tally.seconds},
      {"marched_per_ray", static_cast<double>(tally.marched) / rays},
      {"samples_per_ray", static_cast<double>(tally.shaded) / rays},
      {"occupied", model.grid->OccupiedFraction()},
      {"learning_rate", model.config.optimizer.learning_rate *
                            LearningRateFactor(model.config.schedule, step, Options().steps)}};
  if (!data.validation.empty()) line["validation_psnr"] = validation_psnr;
  file << line.dump() << "\n" << std::flush;
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
  checkpoint.meta["threads"] = NumThreads();
  checkpoint.meta["validation_psnr"] = validation_psnr;
  WriteCheckpoint(CheckpointPath(run), checkpoint);
}

Trainer::Trainer(const Config& config, const SceneFacts& scene, const Dataset& data,
                 const std::filesystem::path& run)
    : state_(std::make_unique<State>(MakeModel(config, scene), data, run)) {
  KeepVisibleCells(*state_->model.grid, data.train);
}

Trainer::Trainer(const Checkpoint& checkpoint, const Dataset& data,
                 const std::filesystem::path& run)
    : state_(std::make_unique<State>(ModelFromCheckpoint(checkpoint), data, run)) {
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

TrainSummary Trainer::Run(const std::atomic<bool>& stop) {
  State& s = *state_;
  const TrainOptions& options = s.Options();
  sfm::WriteFileAtomically(MetricsPath(s.run), MetricsUntil(MetricsPath(s.run), s.step));
  std::ofstream metrics(MetricsPath(s.run), std::ios::app);
  sfm::ProgressLine progress("training", options.steps, s.step);

  Tally tally;
  double shown_loss = 0, shown_rate = 0;
  while (s.step < options.steps && !stop) {
    const auto begin = Clock::now();
    const std::int64_t rays = s.rays_per_batch;
    const StepResult result = s.Step();
    s.AdaptBatch(result.shaded);
    ++s.step;
    const double seconds = SecondsSince(begin);
    s.training_seconds += seconds;
    tally.Add(result, rays, seconds);

    constexpr double kSmoothing = 0.95;
    const double keep = tally.steps == 1 && shown_rate == 0 ? 0.0 : kSmoothing;
    shown_loss = keep * shown_loss + (1 - keep) * result.loss;
    shown_rate = keep * shown_rate + (1 - keep) * static_cast<double>(rays) / seconds;

    const bool last = s.step == options.steps;
    if (last || s.step % options.validate_every == 0) {
      if (!s.data.validation.empty()) s.validation_psnr = s.Validate();
      s.WriteMetrics(metrics, tally);
      tally = {};
    }
    if (last || s.step % options.checkpoint_every == 0) s.Save();
    const std::string psnr =
        s.validation_psnr > 0 ? fmt::format("  val {:.2f} dB", s.validation_psnr) : "";
    progress.Update(
        s.step, fmt::format("loss {:.5f}  {:.1f}k rays/s{}", shown_loss, shown_rate / 1e3, psnr));
  }
  progress.Finish();
  const bool finished = s.step >= options.steps;
  if (!finished) s.Save();
  return {finished, s.step, s.training_seconds, s.validation_psnr};
}

}  // namespace nerf
