#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "nerf/pipeline/events.h"
#include "nerf/pipeline/gaussian_scene.h"
#include "nerf/pipeline/gaussian_validation.h"

namespace nerf {

// Where little or nothing is left of a time budget.
inline constexpr double kLeastFitSeconds = 1;

// How long a fit takes, and what it writes.
struct GaussianPlan {
  double seconds = 0;               // of the fit, without what was spent on it before; 0: by steps
  std::int64_t steps = 0;           // iterations, where there is no time
  std::filesystem::path file = {};  // RUN/splats.nerf; empty: nothing is written
  std::int64_t checkpoint_every = 0;  // iterations; 0: only at the end
  double target_psnr = 0;             // dB, on validation photographs; 0: none
  // At most as many Gaussians as are drawn in this time, so the result depends on the machine and
  // what else it does; 0: all.
  double seconds_per_frame = 0;
  std::function<void()> before_writing = [] {};
};

struct GaussianResult {
  GaussianModel model;
  GaussianSummary summary;
};

// Fits Gaussians to the end, or until `stop` is set; then they are written with what resuming
// needs. By steps, without a time for a frame, the result is the same bits, whether it was
// interrupted or not. By time it ends
// in time, with its last validation.
//   validation  null, or empty: there is none
// Throws NonFiniteError naming the iteration; the last file stays.
GaussianResult FitGaussians(const GaussianScene& scene, GaussianStart start,
                            const GaussianValidation* validation, const GaussianPlan& plan,
                            const std::atomic<bool>& stop, const PipelineListener& listener);

// Where a fit was interrupted; nullopt: the Gaussians of the file have ended.
//   plan  gets the steps, or what is left of the seconds, that the fit was planned for
// Throws InputError naming a damaged file.
std::optional<GaussianStart> StartAgain(const std::filesystem::path& file, GaussianPlan& plan);

}  // namespace nerf
