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

// What a training reports while it runs, in the thread that trains.
struct StepTaken {
  std::int64_t step = 0;                // steps so far
  double spent_seconds = 0;             // of the whole command
  double loss = 0;                      // of this step
  double rays_per_second = 0;           // of this step
  const QualityCurve* curve = nullptr;  // of the validations so far
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
  bool finished = false;  // false: stopped on request, saved, to be resumed
  std::int64_t step = 0;
  double training_seconds = 0;  // without validation and saving
  double validation_psnr = 0;   // dB, on a fixed sample of validation pixels; 0: none held out
  bool reached_target = false;
  QualityCurve curve;
};

// Trains a model: draws pixels, lets the engine compute gradients, steps the optimiser, keeps the
// occupancy grid fresh, validates, writes metrics.jsonl and checkpoints into the run folder.
class Trainer {
 public:
  // A new run. `data` must outlive the trainer.
  //   spent  seconds of train.time_budget that are gone already
  Trainer(const Config& config, const SceneFacts& scene, const Dataset& data,
          const std::filesystem::path& run, double spent = 0);
  // A run as its checkpoint left it: goes on as if it had never stopped, bit for bit with the same
  // number of threads.
  Trainer(const Checkpoint& checkpoint, const Dataset& data, const std::filesystem::path& run,
          double spent = 0);
  ~Trainer();

  // Takes the run's next steps, as many as there are up to `steps`, without a line of metrics.
  // Returns the mean seconds of those that were taken; 0 where none was.
  double TakeSteps(int steps);

  // Trains until config.train.steps, the end of the time budget, the target PSNR, or until `stop`
  // is set; then saves and returns. Throws NonFiniteError naming the step, ray and stage; the last
  // good checkpoint stays.
  TrainSummary Run(const std::atomic<bool>& stop, const TrainerListener& listener = {});

  // dB, on a fixed sample of validation pixels, of which there must be some, each photograph at its
  // own exposure, fitted, whether the model simulates exposures or not.
  double ValidationPsnrAtOwnExposure() const;

  // For those who look at the model while it trains, from any thread.
  SnapshotSlot& Snapshots();

  // The model between two steps, for the thread that trains.
  const Model& GetModel() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nerf
