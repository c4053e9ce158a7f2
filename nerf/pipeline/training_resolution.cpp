#include "nerf/pipeline/training_resolution.h"

#include <algorithm>
#include <cmath>

namespace nerf {
namespace {

// The longest side, in pixels, that a minute of training on two cores can use: docs/benchmarks.md
// has the measurement. More pixels change nothing then but the memory and the time of rendering.
constexpr double kSideOfAMinute = 640;
constexpr double kMostPixels = 1600;  // as nerfstudio

constexpr double kSecondsPerStep = 0.035;  // of the preset balanced, two cores

}  // namespace

int DownscaleFor(int longest_side, double seconds) {
  const double minutes = std::max(1.0, seconds / 60);
  const double side = std::min(kMostPixels, kSideOfAMinute * std::cbrt(minutes));
  return std::max(1, static_cast<int>(std::lround(longest_side / side)));
}

double TrainingSeconds(const TrainOptions& options) {
  return options.time_budget > 0 ? options.time_budget : kSecondsPerStep * options.steps;
}

}  // namespace nerf
