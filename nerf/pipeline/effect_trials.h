#pragma once

#include <set>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/inspect/verdict.h"
#include "nerf/model/scene_facts.h"
#include "nerf/pipeline/events.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// The result of trials of effects.
struct EffectTrials {
  std::vector<std::string> assignments;  // the decisions, in the form of --set
  double seconds = 0;
};

// Whether an effect should be tried: its verdict is inconclusive and the user has not decided it.
// Without any evidence only some effects are tried (EffectDescriptor::tried_without_evidence).
//   requested  effects that the user has decided
bool ShouldTry(const Verdict& verdict, const std::set<std::string>& requested);

// Decides inconclusive effects by paired trials, with and without the effect: short trainings,
// compared on halves of some photographs that are held out meanwhile (HeldOutHalves). Updates the
// verdicts and reports them. All trials together take at most a seventh of the training, trials
// without evidence at most a twentieth. If that is too short, or there are too few photographs,
// effects stay as configured.
//   verdicts      those of ShouldTry are tried
//   seconds_left  of the time budget, if there is one
//   data          unchanged afterwards; needs sparse depths if depth supervision is tried
EffectTrials RunEffectTrials(const Config& config, const SceneFacts& scene,
                             const std::set<std::string>& requested, double seconds_left,
                             Dataset& data, std::vector<Verdict>& verdicts,
                             const PipelineListener& listener);

}  // namespace nerf
