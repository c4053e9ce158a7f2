#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/scene/dataset.h"
#include "nerf/study/study_plan.h"

namespace nerf {

struct StudyOptions {
  double budget = 600;  // seconds, of all settings
  int downscale = 1;
  std::size_t held_out = 3;  // photographs that every setting is measured on, at most
};

// Trains every setting for its share of the budget, with the effects that the capture calls for, as
// `nerf train` does, and evaluates it on held-out photographs at several rendering qualities.
// Writes study.json after each setting, and goes on where an earlier call with the same options
// stopped.
class Study {
 public:
  //   scene     prepared with the splits of the preset balanced, and inspected
  //   folder    study.json, runs/SETTING and crops/SETTING.png go there
  //   listener  of what training each setting reports
  // Throws InputError where the capture holds no photograph out, or the folder another study.
  Study(PreparedScene scene, const StudyOptions& options, std::filesystem::path folder,
        PipelineListener listener);

  // Until the last setting is done or `stop` is set. Returns whether all are done.
  //   begins  called before each setting with its number, its name and its seconds of training
  bool Run(const std::atomic<bool>& stop,
           const std::function<void(std::size_t, const StudySetting&, double)>& begins);

  std::size_t Settings() const { return settings_.size(); }
  // As in study.json; see Measure in study.cpp for its keys.
  const nlohmann::json& Results() const { return results_; }

 private:
  struct Photographs {
    Dataset data;
    SceneFacts facts;
    double seconds = 0;  // that reading took
  };
  void ReadEarlierResults();
  void DecideEffects();
  Config ConfigOf(const StudySetting& setting, double seconds) const;
  nlohmann::json Measure(const StudySetting& setting, double seconds,
                         const std::atomic<bool>& stop);
  nlohmann::json EvaluateQualities(const ModelSnapshot& model, const std::string& name) const;
  Photographs& Read(const Config& config);
  void MarkFronts();
  void Save() const;

  PreparedScene scene_;
  StudyOptions options_;
  std::filesystem::path folder_;
  PipelineListener listener_;
  std::vector<StudySetting> settings_;
  std::vector<const PosedImage*> held_out_;  // of scene_
  std::map<int, Photographs> photographs_;   // by downscale
  std::vector<std::string> decided_;         // of effects, "effects.NAME=..."
  nlohmann::json results_;
};

}  // namespace nerf
