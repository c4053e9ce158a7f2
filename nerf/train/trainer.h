#pragma once

#include <atomic>
#include <filesystem>
#include <memory>

#include "nerf/model/model.h"
#include "nerf/scene/dataset.h"
#include "nerf/train/quality_curve.h"

namespace nerf {

struct TrainSummary {
  bool finished = false;  // false: stopped on request, saved, to be resumed
  std::int64_t step = 0;
  double training_seconds = 0;  // without validation and saving
  double validation_psnr = 0;   // dB, on a fixed sample of validation pixels; 0: none held out
  bool reached_target = false;
  QualityCurve curve;
};

// Trains a model: draws pixels, lets the engine take gradients, steps the optimiser, keeps the
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

  // Takes the run's next steps without a line of metrics. Returns the seconds that one took.
  double TrySteps(int steps);

  // Trains until config.train.steps, the end of the time budget, the PSNR aimed at, or until `stop`
  // is set; then saves and returns.
  // Throws NonFiniteError naming the step, ray and stage; the last good checkpoint stays.
  TrainSummary Run(const std::atomic<bool>& stop);

  // dB, on a fixed sample of validation pixels, of which there must be some, each photograph at its
  // own exposure, fitted, whether the model simulates exposures or not.
  double ValidationPsnrAtOwnExposure();

  const Model& GetModel() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nerf
