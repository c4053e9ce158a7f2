#include "nerf/train/trainer_state.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/field/tensor_span.h"
#include "nerf/model/parameters.h"
#include "nerf/model/run_folder.h"
#include "nerf/render/non_finite_error.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {
namespace {

// Name of the error map in checkpoints.
constexpr char kErrorsName[] = "sampler.errors";

double Ramp(std::int64_t step, int steps) {
  return steps > 0 ? std::clamp(static_cast<double>(step) / steps, 0.0, 1.0) : 1.0;
}

Annealing AnnealingAt(const Model& model, std::int64_t step) {
  Annealing annealing;
  if (model.proposal) {
    annealing.proposal = Ramp(step, model.config.proposal.anneal_steps);
  } else {
    annealing.detail = Ramp(step, model.config.occupancy.coarse_to_fine_steps);
  }
  return annealing;
}

}  // namespace

Trainer::State::State(Model model_in, const Dataset& data_in, std::filesystem::path run_in,
                      double spent_seconds)
    : model(std::move(model_in)),
      engine(MakeEngine(model)),
      data(data_in),
      run(std::move(run_in)),
      sampler(data.train, Options().error_driven_share,
              model.config.effects.depth_supervision ? model.config.effects.depth_supervision->share
                                                     : 0.0),
      optimizer(NamedParameters(model), model.config.optimizer),
      validation(data.validation, Options().seed),
      progress(Options(), spent_seconds),
      rays_per_batch(std::clamp<std::int64_t>(Options().samples_per_batch / 128, 1,
                                              Options().max_rays_per_batch)) {
  TORCH_CHECK(Options().target_psnr == 0 || !validation.Empty(),
              "Trainer: a target PSNR needs validation photographs");
  if (model.exposure || model.pose_refinement) CheckPhotographs();
}

void Trainer::State::CheckPhotographs() const {
  const std::vector<std::string>& names = model.scene.photographs;
  if (std::ranges::equal(names, data.train, {}, {}, &View::name)) return;
  throw InputError(
      "{}: was trained on {} photographs, but the input has {} or other ones; restore the original "
      "photographs or train again",
      run.string(), names.size(), data.train.size());
}

void Trainer::State::InitializeBackground() {
  constexpr std::int64_t kRaysPerTexel = 32, kMaxRays = 1 << 20;  // about 100 MB
  const std::int64_t rows = model.config.effects.background->resolution;
  const std::int64_t rays = std::min(2 * rows * rows * kRaysPerTexel, kMaxRays);
  TargetBatch batch = PixelSampler(data.train).Sample(rays, Options().seed, 0);
  if (model.exposure) {
    // Colours at the mean exposure, so that photographs with known exposures agree.
    const torch::NoGradGuard no_grad;
    const torch::Tensor gains = model.exposure->Gains().to(torch::kFloat).contiguous();
    const auto gain = Span<const float>(gains);
    for (std::size_t i = 0; i < batch.rgb.size(); ++i) {
      batch.rgb[i] /= gain[3 * batch.photograph[i / 3] + i % 3];
    }
  }
  model.background->Initialize(batch);
}

StepResult Trainer::State::Step() {
  StepSeconds seconds;
  LapTimer timer;
  const std::int64_t rays = rays_per_batch;
  const StepResult result = UpdateParameters(seconds);
  AdaptBatch(result.shaded);
  ++step;
  timer.Lap(seconds.all);
  training_seconds += seconds.all;
  statistics.Add(result, rays, seconds);
  return result;
}

StepContext Trainer::State::Context() const {
  StepContext context;
  context.step = step;
  context.seed = Options().seed;
  context.progress = progress.Fraction(step);
  context.learning_rate_factor = LearningRateFactor(model.config.schedule, step, context.progress);
  context.annealing = AnnealingAt(model, step);
  return context;
}

StepResult Trainer::State::UpdateParameters(StepSeconds& seconds) {
  const StepContext context = Context();
  model.annealing = context.annealing;
  try {
    LapTimer timer;
    double engine_seconds = 0;  // in result.seconds
    if (step % model.config.occupancy.update_every == 0) engine->UpdateOccupancy(context);
    timer.Lap(seconds.occupancy);
    const TargetBatch batch = sampler.Sample(rays_per_batch, context.seed, step);
    timer.Lap(seconds.pixels);
    const StepResult result = engine->AccumulateGradients(batch, context);
    timer.Lap(engine_seconds);
    if (ErrorMap* errors = sampler.Errors()) errors->Update(batch.cell, result.ray_error);
    timer.Lap(seconds.pixels);
    optimizer.Step(context.learning_rate_factor);
    timer.Lap(seconds.optimizer);
    return result;
  } catch (const NonFiniteError& error) {
    throw NonFiniteError(fmt::format("step {}: {}; the last good checkpoint stays in {}", step,
                                     error.what(), run.string()));
  }
}

void Trainer::State::AdaptBatch(std::int64_t shaded) {
  const double ratio = static_cast<double>(Options().samples_per_batch) /
                       static_cast<double>(std::max<std::int64_t>(1, shaded));
  const double target = static_cast<double>(rays_per_batch) * std::clamp(ratio, 0.5, 2.0);
  rays_per_batch = std::clamp<std::int64_t>(std::llround(target), 1, Options().max_rays_per_batch);
}

bool Trainer::State::ReachedTarget() const {
  return Options().target_psnr > 0 && validation_psnr >= Options().target_psnr;
}

nlohmann::json Trainer::State::Metrics() const {
  nlohmann::json line = statistics.Metrics();
  line["step"] = step;
  line["seconds"] = training_seconds;
  line["spent_seconds"] = progress.SpentSeconds();
  line["occupied"] = model.grid->OccupiedFraction();
  line["learning_rate"] = model.config.optimizer.learning_rate *
                          LearningRateFactor(model.config.schedule, step, progress.Fraction(step));
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
  checkpoint.meta["spent_seconds"] = progress.SpentSeconds();
  checkpoint.meta["threads"] = NumThreads();
  checkpoint.meta["validation_psnr"] = validation_psnr;
  WriteCheckpoint(CheckpointPath(run), checkpoint);
}

void Trainer::State::Load(const Checkpoint& checkpoint) {
  try {
    optimizer.LoadFrom(checkpoint.tensors);
    if (ErrorMap* errors = sampler.Errors()) {
      std::vector<float> kept(errors->Errors().size());
      CopyTensor(checkpoint.tensors, kErrorsName,
                 torch::from_blob(kept.data(), {static_cast<std::int64_t>(kept.size())}));
      errors->SetErrors(kept);
    }
    step = checkpoint.meta.at("step");
    rays_per_batch = checkpoint.meta.at("rays_per_batch");
    training_seconds = checkpoint.meta.at("training_seconds");
    validation_psnr = checkpoint.meta.at("validation_psnr");
    if (step < 0 || rays_per_batch < 1 || rays_per_batch > Options().max_rays_per_batch) {
      throw InputError("{}: step or rays_per_batch is out of range; train again",
                       CheckpointPath(run).string());
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError("{}: {}; train again", CheckpointPath(run).string(), error.what());
  }
}

}  // namespace nerf
