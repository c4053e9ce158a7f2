#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/effects/inspection.h"
#include "nerf/field/pose_refinement.h"
#include "nerf/scene/data_plan.h"
#include "nerf/scene/dataset.h"
#include "nerf/train/trainer.h"
#include "sfm/colmap_runner.h"

namespace nerf {

// What the pipeline reports on its way, in the order in which it may happen. The terminal is one
// listener among others.

// About the input, one line; the work goes on.
struct Warning {
  std::string text;
};
// COLMAP has found the poses of plain photographs.
struct PosesFound {
  sfm::ColmapReport report;
};
struct InspectionProgress {
  std::int64_t done = 0, photographs = 0;
};
// The verdicts of all effects, before trials.
struct CaptureInspected {
  const Inspection* inspection = nullptr;
  std::set<std::string> requested;  // effects that the user decides
  double seconds = 0;
};
// What will be read and held, before it is.
struct DataPlanned {
  DataPlan plan;
  int width = 0, height = 0;  // of the largest photograph, downscaled
  int threads = 0;
};
// A verdict that changed after the inspection, by a trial or by what all photographs show.
struct VerdictReached {
  Verdict verdict;
};
struct EffectsTried {
  double seconds = 0;
};
// Effects whose evidence was not conclusive and which were not tried: they stay as configured.
struct EffectsUndecided {
  std::vector<std::string> effects;
};
struct BudgetPlanned {
  double seconds = 0;  // the budget
  std::string preset;
  double steps = 0;  // that there is time for, about
};
struct PosesRefined {
  PoseRefinementSummary summary;  // shifts in units of the input
};
struct TrainingEnded {
  TrainSummary summary;
  TrainOptions options;
  std::filesystem::path run;
};

using PipelineEvent = std::variant<Warning, PosesFound, InspectionProgress, CaptureInspected,
                                   DataPlanned, VerdictReached, EffectsTried, EffectsUndecided,
                                   BudgetPlanned, TrainerEvent, PosesRefined, TrainingEnded>;
using PipelineListener = std::function<void(const PipelineEvent&)>;

// The listener of those who are not interested.
inline void IgnoreEvents(const PipelineEvent&) {}

}  // namespace nerf
