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
  std::vector<std::string> assignments;  // what they decided
  double seconds = 0;
};

// Whether a verdict is to be tried: not conclusive, and not of the user's choosing. Without any
// evidence only effects are tried that are worth it (EffectDescriptor::tried_without_evidence).
//   requested  effects that the user decides
bool IsOpen(const Verdict& verdict, const std::set<std::string>& requested);

// Decides what the evidence left open by paired trials, with the effect and without it: short
// trainings, measured on halves of some photographs, which are held out meanwhile (HeldOutHalves).
// Writes the results into the verdicts, and reports them. All trials together take no more than a
// seventh of the training, and without evidence no more than a twentieth; where that is too short,
// or photographs are too few, what is open stays as configured.
//   verdicts      those that are open (IsOpen) are tried
//   seconds_left  of the time budget, where there is one
//   data          is as it was afterwards; has sparse depths where depth supervision is open
EffectTrials RunEffectTrials(const Config& config, const SceneFacts& scene,
                             const std::set<std::string>& requested, double seconds_left,
                             Dataset& data, std::vector<Verdict>& verdicts,
                             const PipelineListener& listener);

}  // namespace nerf
