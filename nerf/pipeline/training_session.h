#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/stopwatch.h"
#include "nerf/config/config.h"
#include "nerf/pipeline/effect_decisions.h"
#include "nerf/pipeline/effects_request.h"
#include "nerf/pipeline/events.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/train/trainer.h"

namespace nerf {

// What is to be trained.
struct TrainingRequest {
  std::filesystem::path input;
  std::filesystem::path run;  // folder of the results
  std::string preset = "balanced";
  bool preset_is_given = false;          // else a time budget chooses it
  std::vector<std::string> assignments;  // "block.key=value"
  EffectsRequest effects;
  int threads = 0;  // 0: all cores
};

// From an input to a trained run: what `nerf train` does, for whoever asks. Reports events in the
// thread that calls it.
class TrainingSession {
 public:
  //   watch  started with the command: a time budget counts from there
  TrainingSession(TrainingRequest request, const Stopwatch& watch, PipelineListener listener);
  // A run as it was left; only `run` and `threads` of the request count.
  static std::unique_ptr<TrainingSession> Resume(TrainingRequest request, const Stopwatch& watch,
                                                 PipelineListener listener);

  // The steps in their order, or the rest of them; Run calls all that have not been called.
  void PrepareCapture();  // poses, splits, inspection; writes config.json and transforms.json
  void ReadPhotographs();
  void DecideEffects();  // by trials, where the inspection left something open
  void PlanTimeBudget();
  TrainSummary Train(const std::atomic<bool>& stop);

  // All of them. Throws InputError, NonFiniteError.
  TrainSummary Run(const std::atomic<bool>& stop);

  // The configuration with what is decided so far.
  const Config& GetConfig() const { return config_; }
  const PreparedScene& Scene() const { return scene_; }
  // Once there is a trainer, that is after PlanTimeBudget.
  Trainer& GetTrainer() { return *trainer_; }

 private:
  Config Configured(const std::string& preset) const;
  void WriteConfig() const;
  void RefuseForeignFolder() const;
  void RequireValidation() const;
  double SpentSeconds() const;
  void ReportRefinedPoses() const;

  TrainingRequest request_;
  Stopwatch watch_;
  PipelineListener listener_;
  Config config_;
  PreparedScene scene_;
  PosedImages posed_;  // as the run's transforms.json has them
  EffectDecisions decisions_;
  Dataset data_;
  SceneFacts facts_;
  std::unique_ptr<Trainer> trainer_;
};

}  // namespace nerf
