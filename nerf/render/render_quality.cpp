#include "nerf/render/render_quality.h"

#include <algorithm>
#include <cmath>

#include "sfm/input_error.h"

namespace nerf {
namespace {

// The fast end.
constexpr double kFewestSamples = 1.0 / 3;  // of those that were trained
constexpr double kMinWeight = 0.02;
constexpr double kStopTransmittance = 0.02;
constexpr double kSmallest = 1e-4;  // share of a pixel that counts as nothing

// From `exact` to `fast` by equal ratios.
double Between(double exact, double fast, double dial) {
  return exact * std::pow(fast / exact, 1 - dial);
}

}  // namespace

RenderQuality RenderQuality::Of(double dial, const MarchOptions& march,
                                const ProposalOptions& proposal) {
  if (!(dial >= 0 && dial <= 1)) {
    throw sfm::InputError("--quality {}: use 0 (fast) to 1 (exact)", dial);
  }
  if (dial == 1) return {1, proposal.samples, 0, march.stop_transmittance};
  RenderQuality quality;
  quality.packet = dial < 0.4 ? 16 : dial < 0.8 ? 4 : 1;
  const double samples = Between(1, kFewestSamples, dial) * proposal.samples;
  quality.samples = std::max(1, static_cast<int>(std::lround(samples)));
  quality.min_weight = Between(kSmallest, kMinWeight, dial);
  quality.stop_transmittance =
      std::max(march.stop_transmittance, Between(kSmallest, kStopTransmittance, dial));
  return quality;
}

}  // namespace nerf
