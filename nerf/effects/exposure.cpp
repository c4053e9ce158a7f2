#include "nerf/effects/exposure.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"

namespace nerf {
namespace {

constexpr double kStops = 0.1;  // threshold: standard deviation over the photographs

}  // namespace

Verdict JudgeExposure(const std::vector<double>& stops, const std::string& source) {
  double squares = 0, largest = 0;
  for (const double s : stops) {
    squares += s * s;
    largest = std::max(largest, std::fabs(s));
  }
  const double spread = std::sqrt(squares / static_cast<double>(stops.size()));
  return Measured(kExposureEffect.name, spread, kStops,
                  fmt::format("photographs differ by {:.2f} stops ({:.2f} at most) {} (threshold "
                              "{:.2f})",
                              spread, largest, source, kStops));
}

const EffectDescriptor kExposureEffect = {
    .name = "exposure",
    .old_name = nullptr,
    .help = "a gain for each photograph and channel: exposure and white balance that differ",
    .stage = "exposure",
    .parameters = "exposure.",
    .judge =
        [](const CaptureEvidence& e) {
          return e.stops.empty() ? Undecided(kExposureEffect.name, e.unknown_because)
                                 : JudgeExposure(e.stops, e.stops_source);
        },
    // Exposures often differ, and the gain can be ten decibels.
    .tried_without_evidence = true,
};

}  // namespace nerf
