#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "nerf/config/config.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"
#include "nerf/study/study_plan.h"

namespace nerf {

struct StudyOptions {
  double budget = 600;  // seconds, of all settings
  int downscale = 1;
  std::size_t held_out = 3;  // photographs that every setting is measured on, at most
};

// Trains every setting for its share of the budget and measures it on held-out photographs at
// several positions of the dial. Writes study.json after each setting, and goes on where an earlier
// call with the same options stopped.
class Study {
 public:
  //   posed    with poses; splits are assigned here
  //   folder   study.json, runs/SETTING and crops/SETTING.png go there
  // Throws InputError where the capture holds no photograph out, or the folder another study.
  Study(PosedImages posed, const StudyOptions& options, std::filesystem::path folder);

  // Until the last setting is done or `stop` is set. Returns whether all are done.
  //   begins  called before each setting with its number, its name and its seconds of training
  bool Run(const std::atomic<bool>& stop,
           const std::function<void(std::size_t, const StudySetting&, double)>& begins);

  std::size_t Settings() const { return settings_.size(); }
  // As in study.json; see JsonOf in study.cpp for its keys.
  const nlohmann::json& Results() const { return results_; }

 private:
  struct Photographs {
    Dataset data;
    double seconds = 0;  // that reading took
  };
  nlohmann::json Measure(const StudySetting& setting, double seconds,
                         const std::atomic<bool>& stop);
  const Photographs& Read(const Config& config);
  void MarkFronts();
  void Save() const;

  PosedImages posed_;
  StudyOptions options_;
  std::filesystem::path folder_;
  std::vector<StudySetting> settings_;
  SceneNormalization normalized_from_world_;
  std::vector<const PosedImage*> held_out_;
  std::map<int, Photographs> photographs_;  // by downscale
  nlohmann::json results_;
};

}  // namespace nerf
