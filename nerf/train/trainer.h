#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <variant>

#include "nerf/model/model.h"
#include "nerf/model/snapshot.h"
#include "nerf/scene/dataset.h"
#include "nerf/train/quality_curve.h"

namespace nerf {

// Events of a running training, reported in the training thread.
struct StepTaken {
  std::int64_t step = 0;                // steps so far
  double spent_seconds = 0;             // of the whole command
  double loss = 0;                      // of this step
  double rays_per_second = 0;           // of this step
  const QualityCurve* curve = nullptr;  // of all validations
};
struct Validated {
  std::int64_t step = 0;
  double training_seconds = 0;
  double psnr = 0;  // dB
};
struct CheckpointWritten {
  std::int64_t step = 0;
};
using TrainerEvent = std::variant<StepTaken, Validated, CheckpointWritten>;
using TrainerListener = std::function<void(const TrainerEvent&)>;

struct TrainSummary {
  bool finished = false;  // false: stopped on request, can be resumed
  std::int64_t step = 0;
  double training_seconds = 0;  // without validation and saving
  double validation_psnr = 0;   // dB, on a fixed sample of validation pixels; 0: no validation
  bool reached_target = false;
  QualityCurve curve;
};

// Trains a model: samples pixels, computes gradients with an engine, steps the optimizer, updates
// the occupancy grid, validates, and writes metrics.jsonl and checkpoints to the run folder.
class Trainer {
 public:
  // A new run. `data` must outlive the trainer.
  //   spent_seconds  already spent of train.time_budget
  Trainer(const Config& config, const SceneFacts& scene, const Dataset& data,
          const std::filesystem::path& run, double spent_seconds = 0);
  // Resumes a run from its checkpoint. With the same number of threads, the result is bit for bit
  // that of an uninterrupted run.
  Trainer(const Checkpoint& checkpoint, const Dataset& data, const std::filesystem::path& run,
          double spent_seconds = 0);
  ~Trainer();

  // Takes up to `steps` of the run's remaining steps, without writing metrics. Returns the mean
  // seconds per step; 0 if no steps remain.
  double TakeSteps(int steps);

  // Trains until config.train.steps, the end of the time budget, the target PSNR, or until `stop`
  // is set; then saves and returns. Throws NonFiniteError naming the step, ray and stage; the last
  // good checkpoint stays.
  //   until  position in the training, 0 to 1, at which to save and return early
  TrainSummary Run(const std::atomic<bool>& stop, const TrainerListener& listener = {},
                   double until = 1);
  // Ends a training with a time budget earlier or later: at these seconds since it began.
  void EndAt(double seconds);
  // Taken so far.
  std::int64_t Steps() const;
  // Since it began, with what was spent before.
  double SpentSeconds() const;

  // PSNR, dB, on a fixed sample of validation pixels, each photograph at its own fitted exposure,
  // whether the model simulates exposures or not. Needs validation photographs.
  double ValidationPsnrAtOwnExposure() const;

  // Snapshots of the model during training, for any thread; it outlives the trainer. Its last one,
  // if any was requested, is of the last step.
  const std::shared_ptr<SnapshotSlot>& Snapshots() const;

  // The current model; only for the training thread.
  const Model& GetModel() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nerf
