#include "nerf/effects/unbounded.h"

#include <spdlog/fmt/fmt.h>

#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"

namespace nerf {

Verdict JudgeUnbounded(const std::optional<Ball>& hull) {
  if (!hull) {
    return Fact(kUnboundedEffect.name, true, 0,
                "the visual hull by alpha may extend beyond 2 radii");
  }
  return Fact(
      kUnboundedEffect.name, hull->radius > kNearRadius, hull->radius,
      fmt::format("the visual hull by alpha is in a ball of {:.2f} radii (threshold {:.1f})",
                  hull->radius, kNearRadius));
}

Verdict JudgeUnbounded(const PointShares& shares, bool may_learn_background) {
  const bool bounded = may_learn_background && IsBeforeBackground(shares);
  return Fact(kUnboundedEffect.name, !bounded, shares.between,
              fmt::format("{:.1f} % of the points are from {:.1f} to {:.0f} radii away{}",
                          100 * shares.between, kNearRadius, kFarRadius,
                          bounded ? ": nothing in front of the background" : ""));
}

const EffectDescriptor kUnboundedEffect = {
    .name = "unbounded",
    .old_name = nullptr,
    .help = "matter at any distance, in contracted space; without it rays end at the unit ball",
    .stage = "march",
    .judge =
        [](const CaptureEvidence& e) {
          if (!e.has_poses) return Undecided(kUnboundedEffect.name, e.unknown_because);
          if (e.HasAlpha()) return JudgeUnbounded(e.hull);
          if (e.has_points) return JudgeUnbounded(e.shares, e.may_learn_background);
          return Fact(kUnboundedEffect.name, true, 0,
                      "photographs without alpha show surroundings");
        },
};

}  // namespace nerf
