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

// The options of a training session.
struct TrainingRequest {
  std::filesystem::path input;
  std::filesystem::path run;  // output folder
  std::string preset = "balanced";
  bool preset_is_given = false;          // otherwise a time budget chooses the preset
  std::vector<std::string> assignments;  // "block.key=value"
  EffectsRequest effects;
  std::filesystem::path lights;  // a lights.json, for materials; empty: none
};

// The whole of `nerf train`, from an input to a trained run. Reports events one at a time, in the
// calling thread, but for InspectionProgress, which comes from worker threads.
class TrainingSession {
 public:
  //   watch  started with the command: the time budget includes what came before this session
  TrainingSession(TrainingRequest request, const Stopwatch& watch, PipelineListener listener);
  TrainingSession(const TrainingSession&) = delete;  // the trainer has a reference to the data
  TrainingSession& operator=(const TrainingSession&) = delete;
  // Resumes a run.
  static std::unique_ptr<TrainingSession> Resume(const std::filesystem::path& run,
                                                 const Stopwatch& watch, PipelineListener listener);

  // Runs to the end, or until `stop` is set. Once. Throws InputError, NonFiniteError.
  TrainSummary Run(const std::atomic<bool>& stop);

  // The configuration with the decisions so far.
  const Config& GetConfig() const { return config_; }

 private:
  // The stages, in order; a resumed run has only the last.
  void PrepareCapture();  // poses, splits, inspection; writes config.json and transforms.json
  void ReadPhotographs();
  void DecideEffects();  // runs trials for inconclusive effects
  void PlanTimeBudget();
  TrainSummary Train(const std::atomic<bool>& stop);
  std::optional<std::filesystem::path> WritePicture(Representation best) const;
  void EstimateWait() const;
  void ChooseResolution();
  Config ConfigWithDecisions(const std::string& preset) const;
  void WriteConfig() const;
  void CheckRunFolder() const;
  void RequireValidation() const;
  double SpentSeconds() const;
  void ReportRefinedPoses() const;

  TrainingRequest request_;
  Stopwatch watch_;
  PipelineListener listener_;
  Config config_;
  PreparedScene scene_;
  PosedImages posed_;  // as read from the run's transforms.json
  EffectDecisions decisions_;
  Dataset data_;
  SceneFacts facts_;
  std::unique_ptr<Trainer> trainer_;
};

}  // namespace nerf
