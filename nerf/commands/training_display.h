#pragma once

#include <optional>

#include "nerf/base/progress.h"
#include "nerf/pipeline/events.h"

namespace nerf {

// What was taken out of a film, in words.
std::string DescribeFrames(const sfm::FilmFrames& frames, const std::filesystem::path& folder);

// A pipeline listener that prints to the terminal: results to standard output, warnings and
// progress to standard error.
class TrainingDisplay {
 public:
  void operator()(const PipelineEvent& event);
  // Clears the progress line.
  void Finish() { progress_.reset(); }

 private:
  void Show(const Warning& event);
  void Show(const WaitEstimated& event);
  void Show(const FilmRead& event);
  void Show(const PosesFound& event);
  void Show(const PointsFound& event);
  void Show(const ResolutionChosen& event);
  void Show(const InspectionProgress& event);
  void Show(const CaptureInspected& event);
  void Show(const DataPlanned& event);
  void Show(const VerdictReached& event);
  void Show(const EffectsTried& event);
  void Show(const EffectsUndecided& event);
  void Show(const BudgetPlanned& event);
  void Show(const TrainingBegan& event) { train_ = event.options; }
  void Show(const PosesRefined& event);
  void Show(const TrainingEnded& event);
  void Show(const TrainerEvent& event);
  void Show(const SurfacesRendered& event);
  void Show(const LightEffectsDecided& event);
  void Show(const MaterialsStepped& event);
  void Show(const MaterialsFound& event);
  void Show(const GaussiansStepped& event);
  void Show(const RepresentationDecided& event);
  void Show(const GaussiansFailed& event);
  void Show(const GaussiansEnded& event);
  void Show(const StepTaken& event);

  TrainOptions train_;
  std::optional<ProgressLine> progress_;
  double loss_ = 0, rays_per_second_ = 0;  // running means
};

}  // namespace nerf
