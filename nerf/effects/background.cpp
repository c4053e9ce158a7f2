#include "nerf/effects/background.h"

#include <spdlog/fmt/fmt.h>

#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"

namespace nerf {

Verdict JudgeBackground(const PointShares& shares) {
  const Verdict verdict = Measured(
      kBackgroundEffect.name, shares.far, kFarAway,
      fmt::format("{:.1f} % of the points are more than {:.0f} radii away (threshold {:.1f} %){}",
                  100 * shares.far, kFarRadius, 100 * kFarAway,
                  shares.far >= kFarAway && !IsBeforeBackground(shares)
                      ? ", but there are points in between: contracted space represents both"
                      : ""));
  // A decision together with `unbounded`, which is a fact: both are equally conclusive.
  if (!verdict.on) return verdict;
  return Fact(kBackgroundEffect.name, IsBeforeBackground(shares), shares.far, verdict.evidence);
}

const EffectDescriptor kBackgroundEffect = {
    .name = "background",
    .old_name = nullptr,
    .help = "a learned colour for each direction behind everything, such as a sky",
    .stage = "background",
    .parameters = "background.",
    .judge =
        [](const CaptureEvidence& e) {
          if (e.HasAlpha()) {
            return Fact(kBackgroundEffect.name, false, 0,
                        "photographs with alpha have no background");
          }
          return e.HasTracks() ? JudgeBackground(e.shares)
                               : Undecided(kBackgroundEffect.name, e.unknown_because);
        },
};

}  // namespace nerf
