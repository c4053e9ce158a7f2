#include "nerf/effects/view_dependence.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <map>
#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/inspect/angle_residuals.h"
#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"

namespace nerf {
namespace {

constexpr std::size_t kFewestViews = 5;       // of a point
constexpr double kViewDependentShare = 0.12;  // threshold: share of points whose colour changes

}  // namespace

Verdict JudgeViewDependence(const TrackColors& colors, const PhotographFit& fit) {
  struct Spread {
    std::vector<double> residual, contrast;
  };
  std::map<int, Spread> of_point;
  for (std::size_t i = 0; i < colors.seen.size(); ++i) {
    Spread& spread = of_point[colors.seen[i].point];
    spread.residual.push_back(std::fabs(static_cast<double>(fit.residuals[i].mean())));
    spread.contrast.push_back(static_cast<double>(colors.seen[i].contrast));
  }
  std::size_t judged = 0, changing = 0;
  for (auto& [point, spread] : of_point) {
    if (spread.residual.size() < kFewestViews) continue;
    ++judged;
    const double change = kDeviationOfMedian * Quantile(spread.residual, 0.5);
    if (change > kTexturelessVariation + Quantile(spread.contrast, 0.5)) ++changing;
  }
  if (judged < kFewestPoints) {
    return Undecided(kViewDependenceEffect.name,
                     fmt::format("only {} points have {} or more sightings", judged, kFewestViews));
  }
  const double share = static_cast<double>(changing) / static_cast<double>(judged);
  return Measured(kViewDependenceEffect.name, share, kViewDependentShare,
                  fmt::format("the colour of {:.1f} % of the points changes with the view by more "
                              "than their texture explains (threshold {:.0f} %)",
                              100 * share, 100 * kViewDependentShare));
}

const EffectDescriptor kViewDependenceEffect = {
    .name = "view_dependence",
    .old_name = "view",
    .help = "colour that depends on the viewing direction: gloss and mirrors",
    .stage = "colour network",
    .judge =
        [](const CaptureEvidence& e) {
          return e.HasTracks() ? JudgeViewDependence(e.colors, e.fit)
                               : Undecided(kViewDependenceEffect.name, e.unknown_because);
        },
};

}  // namespace nerf
