#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/scene/dataset.h"
#include "nerf/study/study_plan.h"

namespace nerf {

struct StudyOptions {
  double budget = 600;  // seconds, for all settings
  int downscale = 1;
  std::size_t held_out = 3;  // largest number of photographs to evaluate each setting on
};

// A study: trains a grid of settings, each for its share of the budget and with the effects that
// `nerf train` would choose, and evaluates them on held-out photographs, fields at several
// rendering qualities, Gaussians as they are. Writes study.json after each setting, and continues
// an earlier study with the same options.
class Study {
 public:
  //   scene     prepared with the splits of the preset `balanced`, and inspected
  //   folder    of study.json, runs/SETTING and crops/SETTING.png
  //   listener  receives the events of each training
  // Throws InputError if no photograph is held out, or the folder contains another study.
  Study(PreparedScene scene, const StudyOptions& options, std::filesystem::path folder,
        PipelineListener listener);
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

  // Runs until all settings are done or `stop` is set. Returns whether all are done.
  //   on_begin  called before each setting with its number, the setting and its training seconds
  bool Run(const std::atomic<bool>& stop,
           const std::function<void(std::size_t, const StudySetting&, double)>& on_begin);

  std::size_t Settings() const { return settings_.size(); }
  // The content of study.json; its keys are in Measure in study.cpp.
  const nlohmann::json& Results() const { return results_; }

 private:
  struct Photographs {
    Dataset data;
    SceneFacts facts;
    double seconds = 0;  // reading time
  };
  void ReadEarlierResults();
  void DecideEffects();
  Config ConfigOf(const StudySetting& setting, double seconds) const;
  nlohmann::json Measure(const StudySetting& setting, double seconds,
                         const std::atomic<bool>& stop);
  nlohmann::json EvaluateQualities(const SceneModel& model, std::span<const double> qualities,
                                   const PosedImages& posed, const std::string& name);
  Photographs& Read(const Config& config);
  void MarkFronts();
  void Save() const;

  PreparedScene scene_;
  StudyOptions options_;
  std::filesystem::path folder_;
  PipelineListener listener_;
  std::vector<StudySetting> settings_;
  std::vector<std::size_t> held_out_;       // indices of images
  std::map<int, Photographs> photographs_;  // by downscale
  std::vector<std::string> decided_;        // assignments of effects, "effects.NAME=..."
  std::set<std::string> reported_;          // photographs that could not be read
  nlohmann::json results_;
};

}  // namespace nerf
