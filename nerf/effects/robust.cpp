#include "nerf/effects/robust.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"

namespace nerf {
namespace {

constexpr double kOutlierShare = 0.007;  // threshold: share of sightings that are outliers
// An outlier's residual of log light is more than this and more than four standard deviations.
constexpr double kOutlierResidual = 0.35;

}  // namespace

RobustOptions RobustOptions::At(double progress) const {
  return {scale * std::pow(100.0, std::clamp(1 - 2 * progress, 0.0, 1.0))};
}

Verdict JudgeRobust(const TrackColors& colors, const PhotographFit& fit) {
  std::vector<double> residuals;
  for (const auto& residual : fit.residuals) {
    residuals.push_back(std::fabs(static_cast<double>(residual.mean())));
  }
  const double noise = kDeviationOfMedian * Quantile(residuals, 0.5);
  const double limit = std::max(kOutlierResidual, 4 * noise);
  std::size_t outliers = 0;
  for (const Sighting& s : colors.unseen) {
    const Eigen::Vector3f residual =
        s.log_light - fit.of_point[s.point] - fit.of_photograph[s.photograph];
    if (static_cast<double>(residual.cwiseAbs().maxCoeff()) > limit) ++outliers;
  }
  const double share = static_cast<double>(outliers) /
                       static_cast<double>(std::max<std::size_t>(1, colors.seen.size() + outliers));
  return Measured(kRobustEffect.name, share, kOutlierShare,
                  fmt::format("in {:.1f} % of the places where a point should be visible, "
                              "something else is (threshold {:.1f} %)",
                              100 * share, 100 * kOutlierShare));
}

const EffectDescriptor kRobustEffect = {
    .name = "robust",
    .old_name = nullptr,
    .help = "a loss in which large errors have little weight: passers-by, moving shadows",
    .stage = "loss",
    .judge =
        [](const CaptureEvidence& e) {
          return e.HasTracks() ? JudgeRobust(e.colors, e.fit)
                               : Undecided(kRobustEffect.name, e.unknown_because);
        },
};

}  // namespace nerf
