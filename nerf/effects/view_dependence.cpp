#include "nerf/effects/view_dependence.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <map>
#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/inspect/angle_residuals.h"
#include "nerf/inspect/evidence.h"
#include "nerf/inspect/point_shares.h"
#include "nerf/inspect/verdict.h"

namespace nerf {
namespace {

constexpr std::size_t kFewestViews = 5;       // of a point
constexpr double kViewDependentShare = 0.12;  // threshold: share of points whose colour changes

// Points that are found in fewer of the photographs that should show them are those that look alike
// from everywhere: of the chair, whose gloss is worth 3 dB, 8 % of them change.
constexpr double kFewSightings = 1.0 / 3;
constexpr double kInconclusive = 0.4;
// So few of them change on matt captures, whatever matched them: 0.4 to 0.8 % of generated ones,
// 1.4 % where everything is glossy.
constexpr double kMattShare = 0.01;

}  // namespace

Verdict JudgeViewDependence(const TrackColors& colors, const PhotographFit& fit,
                            const PosedImages& posed) {
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
  Verdict verdict =
      Measured(kViewDependenceEffect.name, share, kViewDependentShare,
               fmt::format("the colour of {:.1f} % of the points changes with the view by more "
                           "than their texture explains (threshold {:.0f} %)",
                           100 * share, 100 * kViewDependentShare));
  if (!verdict.on && share >= kMattShare && SightedShare(posed) < kFewSightings) {
    verdict.most_confidence = kInconclusive;
    verdict.evidence += ", but glossy places rarely match";
  }
  return verdict;
}

const EffectDescriptor kViewDependenceEffect = {
    .name = "view_dependence",
    .old_name = "view",
    .help = "colour that depends on the viewing direction: gloss and mirrors",
    .stage = "colour network",
    .judge =
        [](const CaptureEvidence& e) {
          return e.HasTracks() ? JudgeViewDependence(e.colors, e.fit, *e.posed)
                               : Undecided(kViewDependenceEffect.name, e.unknown_because);
        },
};

}  // namespace nerf
