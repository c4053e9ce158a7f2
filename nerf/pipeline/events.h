#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/effects/inspection.h"
#include "nerf/field/pose_refinement.h"
#include "nerf/model/representation_record.h"
#include "nerf/model/snapshot.h"
#include "nerf/scene/data_plan.h"
#include "nerf/scene/dataset.h"
#include "nerf/train/quality_curve.h"
#include "nerf/train/trainer.h"
#include "sfm/colmap_runner.h"
#include "sfm/film.h"
#include "sfm/sparse_points.h"

namespace nerf {

// Events that the pipeline reports, in the order in which they can occur.

// A problem with the input that does not stop the work, one line.
struct Warning {
  std::string text;
};
// How long everything will take, roughly, before anything is done.
struct WaitEstimated {
  int photographs = 0;      // or frames of a film
  double film_seconds = 0;  // for taking frames out of a film
  double pose_seconds = 0, training_seconds = 0;
};
// Frames were taken out of a film.
struct FilmRead {
  std::filesystem::path film, folder;
  sfm::FilmFrames frames;
};
// COLMAP found the poses of plain photographs.
struct PosesFound {
  sfm::ColmapReport report;
};
// Sparse points were found for poses that were given.
struct PointsFound {
  sfm::SparsePointReport report;
};
// Reported by worker threads, one at a time.
struct InspectionProgress {
  std::int64_t done = 0, photographs = 0;
};
// The resolution that was chosen for photographs, since the user did not.
struct ResolutionChosen {
  int downscale = 1;
  int width = 0, height = 0;  // of the largest photograph, before
};
// The verdicts of all effects, before trials.
struct CaptureInspected {
  const Inspection* inspection = nullptr;  // valid during the call
  std::set<std::string> requested;         // effects that the user has decided
  double seconds = 0;
};
// The plan for reading photographs, before they are read.
struct DataPlanned {
  DataPlan plan;
  int width = 0, height = 0;  // of the largest photograph, downscaled
  int threads = 0;
};
// A verdict that changed after the inspection, by a trial or after reading all photographs.
struct VerdictReached {
  Verdict verdict;
};
struct EffectsTried {
  double seconds = 0;
};
// Effects that are inconclusive and were not tried; they stay as configured.
struct EffectsUndecided {
  std::vector<std::string> effects;
};
struct BudgetPlanned {
  double seconds = 0;        // the budget
  double field_seconds = 0;  // of the field's training, where Gaussians follow
  std::string preset;
  double steps = 0;  // approximate number in these seconds
};
// The first step follows.
struct TrainingBegan {
  TrainOptions options;
  std::shared_ptr<SnapshotSlot> snapshots;  // for who wants to see the model while it trains
};
struct PosesRefined {
  PoseRefinementSummary summary;  // shifts in units of the input
};
struct TrainingEnded {
  TrainSummary summary;
  TrainOptions options;
  std::filesystem::path run;
  std::optional<std::filesystem::path> picture;  // of what it reached
};

// Gaussians: the field's surfaces at the poses of photographs, and iterations.
struct SurfacesRendered {
  std::size_t done = 0, views = 0;
};
struct GaussiansStepped {
  std::int64_t step = 0;
  double fraction = 0;  // of the fit
  double loss = 0;
  double psnr = 0;  // dB, the last validation; 0: none yet
};
// Whether training makes Gaussians.
struct RepresentationDecided {
  bool makes_splats = false;
  std::optional<ComparedPsnr> tried;
  std::string why_not;  // where there was no trial
};
struct GaussianSummary {
  bool finished = false;  // false: stopped on request, and can be resumed
  std::int64_t steps = 0;
  std::int64_t gaussians = 0;
  double seconds = 0;  // of the fit, with what was spent on it before
  double psnr = 0;     // dB, on validation photographs; 0: there are none
  bool reached_target = false;
  double seconds_per_frame = 0;  // 0: none was asked for
  QualityCurve curve;
};
// The field is kept without them, and trained on where there is time.
struct GaussiansFailed {
  std::string why;
};
struct GaussiansEnded {
  GaussianSummary fit;
  std::optional<ComparedPsnr> reached;
};

// Materials: the field's surfaces at the poses of photographs, what of the light is simulated, and
// steps.
struct LightEffectsDecided {
  bool shadows = true, bounces = true, specular = true;
  std::optional<double> blocked;      // share of the light directions; absent: not asked
  std::optional<double> specular_db;  // gain of a coat in a trial; absent: there was none
};
struct MaterialsStepped {
  std::int64_t step = 0;
  double fraction = 0;  // of the fit
  double psnr = 0;      // dB, of the pixels of the last steps
};
struct MaterialsFound {
  bool finished = false;  // false: stopped on request, and can be resumed
  std::int64_t steps = 0;
  double psnr = 0;     // dB, of the pixels of the last steps, against their reflection
  double seconds = 0;  // of the fit
  std::size_t vertices = 0, lights = 0;
  bool is_relative = false;  // some light is found, so that only its product with albedo is known
  std::filesystem::path run;
};

using PipelineEvent =
    std::variant<Warning, WaitEstimated, FilmRead, PosesFound, PointsFound, ResolutionChosen,
                 InspectionProgress, CaptureInspected, DataPlanned, VerdictReached, EffectsTried,
                 EffectsUndecided, BudgetPlanned, TrainingBegan, TrainerEvent, PosesRefined,
                 TrainingEnded, SurfacesRendered, GaussiansStepped, RepresentationDecided,
                 GaussiansFailed, GaussiansEnded, LightEffectsDecided, MaterialsStepped,
                 MaterialsFound>;
using PipelineListener = std::function<void(const PipelineEvent&)>;

// A listener that ignores all events.
inline void IgnoreEvents(const PipelineEvent&) {}

}  // namespace nerf
