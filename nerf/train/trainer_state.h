#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "nerf/model/checkpoint.h"
#include "nerf/render/engine.h"
#include "nerf/scene/pixel_sampler.h"
#include "nerf/train/optimizer.h"
#include "nerf/train/pace.h"
#include "nerf/train/tally.h"
#include "nerf/train/trainer.h"
#include "nerf/train/validation.h"

namespace nerf {

// What a training is made of, and how it takes a step.
struct Trainer::State {
  //   spent  seconds of train.time_budget that are gone already
  State(Model model_in, const Dataset& data_in, std::filesystem::path run_in, double spent);

  const TrainOptions& Options() const { return model.config.train; }

  // What is known of each photograph belongs to those that training began with, in their order.
  // Throws InputError where they are others.
  void CheckPhotographs() const;
  void StartBackground();
  // A step with its book-keeping.
  StepResult Step();
  StepResult Learn(StepSeconds& seconds);
  // Where the training stands now.
  StepContext Context() const;
  // As the grid becomes tight a ray needs fewer samples, and a batch holds more rays.
  void AdaptBatch(std::int64_t shaded);
  bool ReachedTarget() const;
  // Not before the first step: a run without one has nothing to show.
  bool Over() const { return step > 0 && (ReachedTarget() || pace.Progress(step) >= 1); }
  nlohmann::json Metrics() const;
  void Save() const;
  // What Save wrote. Throws InputError naming what is missing or out of range.
  void Load(const Checkpoint& checkpoint);

  Model model;
  std::unique_ptr<Engine> engine;  // borrows the model
  SnapshotSlot snapshots;
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

}  // namespace nerf
