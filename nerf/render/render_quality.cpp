#include "nerf/render/render_quality.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

// The fast end, where the validation view of the fox has lost 1.2 of 32.0 dB.
constexpr double kFewestSamples = 0.42;  // of those that were trained
constexpr double kLargestColorShare = 0.25;
constexpr double kLargestTransmittance = 0.05;

// Packets of 16 cost 0.05 dB there, and save most of what a proposal takes.
constexpr int kPacket = 16;

}  // namespace

RenderQuality RenderQuality::Of(double dial, const MarchOptions& march,
                                const ProposalOptions& proposal) {
  if (!(dial >= 0 && dial <= 1)) {
    throw InputError("--quality {}: use 0 (fast) to 1 (exact)", dial);
  }
  const double exact = march.stop_transmittance;
  if (dial == 1) return {1, proposal.samples, 0, exact};
  const double fast = std::max(exact, kLargestTransmittance);
  const double samples = proposal.samples * (kFewestSamples + dial * (1 - kFewestSamples));
  return {kPacket, std::max(1, static_cast<int>(std::lround(samples))),
          kLargestColorShare * (1 - dial), fast * std::pow(exact / fast, dial)};
}

}  // namespace nerf
