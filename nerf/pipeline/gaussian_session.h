#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/stopwatch.h"
#include "nerf/pipeline/gaussian_training.h"

namespace nerf {

struct GaussianRequest {
  std::filesystem::path run;
  // Seconds from the beginning of the command to the end of the fit; 0: splats.steps iterations, or
  // as an interrupted fit was planned.
  double time_budget = 0;
  std::vector<std::string> assignments;  // "splats.key=value"
  double megabytes = 0;          // as many Gaussians as their PLY file may have; 0: splats.count
  double seconds_per_frame = 0;  // see GaussianPlan
  bool resume = false;           // go on with a fit that was interrupted, with its configuration
};

struct GaussianSession {
  GaussianSummary fit;
  std::optional<ComparedPsnr> reached;  // nullopt: there are no validation photographs
};

// The whole of `nerf splat`: Gaussians for a trained run, which begin at the surfaces that its
// field renders and are fitted to its photographs. Poses, exposures, masks and the meaning of alpha
// are those of the run; where the run simulates no view dependence, the Gaussians have none either.
// Writes RUN/splats.nerf, and goes on with a fit that was interrupted there. Reports events in the
// calling thread.
//   returns  nullopt where it was stopped before the fit began
// Throws NonFiniteError where the fit diverges; then nothing is written. Throws InputError, also
// for a run of linear photographs, which Gaussians are not fitted to yet.
std::optional<GaussianSession> MakeGaussians(const GaussianRequest& request, const Stopwatch& watch,
                                             const std::atomic<bool>& stop,
                                             const PipelineListener& listener);

}  // namespace nerf
