#include "nerf/effects/robust.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "nerf/base/quantile.h"

namespace nerf {
namespace {

constexpr double kPassingShare = 0.007;  // of sightings that show something else
constexpr double kSomethingElse = 0.35;  // log light, and four standard deviations of the residuals

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
  const double limit = std::max(kSomethingElse, 4 * noise);
  std::size_t other = 0;
  for (const Sighting& s : colors.unseen) {
    const Eigen::Vector3f residual =
        s.log_light - fit.of_point[s.point] - fit.of_photograph[s.photograph];
    if (static_cast<double>(residual.cwiseAbs().maxCoeff()) > limit) ++other;
  }
  const double share = static_cast<double>(other) /
                       static_cast<double>(std::max<std::size_t>(1, colors.seen.size() + other));
  return Measured(kRobust.name, share, kPassingShare,
                  fmt::format("in {:.1f} % of the places where a point should be seen stands "
                              "something else (threshold {:.1f} %)",
                              100 * share, 100 * kPassingShare));
}

const EffectDescriptor kRobust = {
    .name = "robust",
    .old_name = nullptr,
    .help = "a loss in which large errors have little weight: passers-by, moving shadows",
    .hook = "loss",
    .judge =
        [](const CaptureEvidence& e) {
          return e.HasTracks() ? JudgeRobust(e.colors, e.fit)
                               : Undecided(kRobust.name, e.unknown_because);
        },
};

}  // namespace nerf
