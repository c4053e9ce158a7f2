#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/model/scene_facts.h"
#include "nerf/pipeline/events.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// Which effects a run simulates that the user has not named: conclusive verdicts are applied,
// undecided ones are tried where there is time.
class EffectDecisions {
 public:
  // As configured.
  EffectDecisions() = default;
  //   requested  effects that the user decides
  EffectDecisions(const Inspection& inspection, std::set<std::string> requested);

  // Whether an effect is to be tried.
  bool IsOpen(const EffectDescriptor& effect) const;

  // Photographs turned out to have alpha, of which too little was seen when a few were inspected:
  // then no background is learned, and contracted space holds what is far.
  void DisableBackgroundForAlpha(const PipelineListener& listener);

  // Decides what is open by paired trials (nerf/pipeline/effect_trials.h).
  //   seconds_left  of the time budget, where there is one
  void Try(const Config& config, const SceneFacts& scene, double seconds_left, Dataset& data,
           const PipelineListener& listener);

  // What was decided so far, as --set takes it.
  const std::vector<std::string>& Assignments() const { return assignments_; }
  const std::set<std::string>& Requested() const { return requested_; }

  // RUN/effects.json: the verdicts with their evidence, who decided, and what is simulated.
  nlohmann::json Report(const Config& config, double inspection_seconds) const;

 private:
  std::vector<Verdict> verdicts_;
  std::set<std::string> requested_;
  std::vector<std::string> assignments_;
  double trial_seconds_ = 0;
};

}  // namespace nerf
