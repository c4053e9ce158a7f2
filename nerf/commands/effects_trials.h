#pragma once

#include <set>
#include <string>
#include <vector>

#include "nerf/config.h"
#include "nerf/data/dataset.h"
#include "nerf/inspect/verdict.h"
#include "nerf/train/model.h"

namespace nerf {

// What trials of effects came to.
struct EffectTrials {
  std::vector<std::string> assignments;  // what they decided
  double seconds = 0;                    // that they took
};

// Decides what the evidence left open by paired trials, with the effect and without it: short
// trainings, measured on some of the photographs to learn from, which are held out meanwhile.
// Writes into the verdicts what came out, and prints it. All trials together take no more than a
// seventh of the training; where that is too short, or photographs are too few, what is open stays
// as configured.
//   verdicts      those that are not sure and that nobody has named are open
//   seconds_left  of the time budget, where there is one
//   data          is as it was afterwards
EffectTrials TryWhatIsOpen(const Config& config, const SceneFacts& scene,
                           const std::set<std::string>& named, double seconds_left, Dataset& data,
                           std::vector<Verdict>& verdicts);

}  // namespace nerf
