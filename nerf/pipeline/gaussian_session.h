#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "nerf/base/stopwatch.h"
#include "nerf/pipeline/events.h"

namespace nerf {

struct GaussianRequest {
  std::filesystem::path run;
  // Seconds from the beginning of the command to the end of the fit, before the validation; 0:
  // splats.steps iterations.
  double time_budget = 0;
  std::vector<std::string> assignments;  // "splats.key=value"
};

struct GaussianSummary {
  // false: stopped on request; the Gaussians so far are kept, but none of 0 steps.
  bool finished = false;
  std::int64_t steps = 0;
  std::int64_t gaussians = 0;
  double seconds = 0;
  double psnr = 0, field_psnr = 0;  // dB, on the validation photographs; 0: there are none
};

// The whole of `nerf splat`: Gaussians for a trained run, which begin at the surfaces that its
// field renders and are fitted to its photographs. Poses, exposures, masks and the meaning of alpha
// are those of the run; where the run simulates no view dependence, the Gaussians have none either.
// Writes RUN/splats.nerf. Reports events in the calling thread.
// Throws NonFiniteError where the fit diverges; then nothing is written. Throws InputError, also
// for a run of linear photographs, which Gaussians are not fitted to yet.
GaussianSummary MakeGaussians(const GaussianRequest& request, const Stopwatch& watch,
                              const std::atomic<bool>& stop, const PipelineListener& listener);

}  // namespace nerf
