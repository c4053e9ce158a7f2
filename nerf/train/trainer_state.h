#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "nerf/model/checkpoint.h"
#include "nerf/render/engine.h"
#include "nerf/scene/pixel_sampler.h"
#include "nerf/train/optimizer.h"
#include "nerf/train/step_statistics.h"
#include "nerf/train/trainer.h"
#include "nerf/train/training_progress.h"
#include "nerf/train/validation.h"

namespace nerf {

// The state of a training, and its steps.
struct Trainer::State {
  //   spent_seconds  already spent of train.time_budget
  State(Model model_in, const Dataset& data_in, std::filesystem::path run_in, double spent_seconds);

  const TrainOptions& Options() const { return model.config.train; }

  // Parameters per photograph need the same photographs in the same order as at the start of the
  // run. Throws InputError if they differ.
  void CheckPhotographs() const;
  void InitializeBackground();
  // One step, with statistics and timing.
  StepResult Step();
  StepResult UpdateParameters(StepSeconds& seconds);
  StepContext Context() const;
  // Adjusts rays_per_batch towards train.samples_per_batch: as the occupancy grid empties, rays
  // need fewer samples.
  void AdaptBatch(std::int64_t shaded);
  bool ReachedTarget() const;
  // Takes at least one step, even if the time budget is used up.
  bool Finished() const { return step > 0 && (ReachedTarget() || progress.Fraction(step) >= 1); }
  nlohmann::json Metrics() const;
  void Save() const;
  // Restores what Save wrote. Throws InputError naming what is missing or out of range.
  void Load(const Checkpoint& checkpoint);

  Model model;
  std::unique_ptr<Engine> engine;  // has a reference to the model
  std::shared_ptr<SnapshotSlot> snapshots = std::make_shared<SnapshotSlot>();
  const Dataset& data;
  std::filesystem::path run;
  PixelSampler sampler;
  Adam optimizer;
  Validation validation;
  TrainingProgress progress;
  StepStatistics statistics;  // since the last line of metrics

  // Stored in checkpoints beside parameters and optimizer. Random numbers depend only on the seed
  // and the step.
  std::int64_t step = 0;
  std::int64_t rays_per_batch;
  double training_seconds = 0;
  double validation_psnr = 0;
};

}  // namespace nerf
