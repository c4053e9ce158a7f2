#pragma once

#include <set>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/inspect/verdict.h"
#include "nerf/model/model.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// What trials of effects came to.
struct EffectTrials {
  std::vector<std::string> assignments;  // what they decided
  double seconds = 0;                    // that they took
};

// Whether a verdict is to be tried: not sure, and of nobody's choosing. Where nothing tells at all,
// exposure alone is: photographs often differ in it, and it may be worth ten decibels.
//   named  effects that a person decides
bool IsOpen(const Verdict& verdict, const std::set<std::string>& named);

// Decides what the evidence left open by paired trials, with the effect and without it: short
// trainings, measured on halves of some photographs, which are held out meanwhile (HeldOutHalves).
// Writes into the verdicts what came out, and prints it. All trials together take no more than a
// seventh of the training, and where nothing tells no more than a twentieth; where that is too
// short, or photographs are too few, what is open stays as configured.
//   verdicts      those that are open (IsOpen) are tried
//   seconds_left  of the time budget, where there is one
//   data          is as it was afterwards; has the points that depth learns from where it is open
EffectTrials TryWhatIsOpen(const Config& config, const SceneFacts& scene,
                           const std::set<std::string>& named, double seconds_left, Dataset& data,
                           std::vector<Verdict>& verdicts);

}  // namespace nerf
