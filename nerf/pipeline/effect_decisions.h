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

// Decides the effects of a run that the user has not decided: conclusive verdicts are applied,
// inconclusive effects are tried if there is time.
class EffectDecisions {
 public:
  // No decisions: effects are as configured.
  EffectDecisions() = default;
  // Applies the conclusive verdicts.
  //   requested  effects that the user has decided
  EffectDecisions(const Inspection& inspection, std::set<std::string> requested);

  // Whether a trial should decide an effect.
  bool ShouldTry(const EffectDescriptor& effect) const;

  // For photographs with alpha that the inspection of a few of them did not find: turns
  // `background` off, and `unbounded` on to represent distant points.
  void DisableBackgroundForAlpha(const PipelineListener& listener);

  // Decides inconclusive effects by paired trials (nerf/pipeline/effect_trials.h).
  //   seconds_left  of the time budget, if there is one
  void RunTrials(const Config& config, const SceneFacts& scene, double seconds_left, Dataset& data,
                 const PipelineListener& listener);

  // The decisions so far, in the form of --set.
  const std::vector<std::string>& Assignments() const { return assignments_; }
  const std::set<std::string>& Requested() const { return requested_; }

  // The content of RUN/effects.json: verdicts with their evidence, decisions, simulated effects.
  nlohmann::json Report(const Config& config, double inspection_seconds) const;

 private:
  std::vector<Verdict> verdicts_;
  std::set<std::string> requested_;
  std::vector<std::string> assignments_;
  double trial_seconds_ = 0;
};

}  // namespace nerf
