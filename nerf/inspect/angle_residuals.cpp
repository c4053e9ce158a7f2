#include "nerf/inspect/angle_residuals.h"

#include <cmath>
#include <numbers>

#include "nerf/base/quantile.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

constexpr double kDegreesEach = 5;
constexpr int kAngles = 36;  // up to 180 degrees
constexpr int kFewestAngles = 5, kFewestOfAngle = 30;

// From a point to the camera of a photograph that sees it.
Vector3d DirectionToCamera(const PosedImages& posed, const Sighting& s) {
  return (posed.images[s.photograph].world_from_camera.translation() -
          posed.points[s.point].x_in_world)
      .normalized();
}

}  // namespace

std::vector<AngleResiduals> ResidualsByAngle(const PosedImages& posed, const TrackColors& colors,
                                             const PhotographFit& fit) {
  std::vector<Vector3d> sum(posed.points.size(), Vector3d::Zero());
  std::vector<int> count(posed.points.size(), 0);
  for (const Sighting& s : colors.seen) {
    sum[s.point] += DirectionToCamera(posed, s);
    ++count[s.point];
  }
  std::vector<std::vector<double>> residuals(kAngles);
  for (std::size_t i = 0; i < colors.seen.size(); ++i) {
    const Sighting& s = colors.seen[i];
    if (count[s.point] < kFewestAngles) continue;
    const Vector3d direction = DirectionToCamera(posed, s), mean = sum[s.point];
    const double radians = std::atan2(direction.cross(mean).norm(), direction.dot(mean));
    const auto at = static_cast<int>(radians * 180 / std::numbers::pi / kDegreesEach);
    const auto left_over = static_cast<double>(std::fabs(fit.left_over[i].mean()));
    residuals[std::min(at, kAngles - 1)].push_back(left_over /
                                                   (kFlatChange + static_cast<double>(s.contrast)));
  }
  std::vector<AngleResiduals> all;
  for (int at = 0; at < kAngles; ++at) {
    const auto sightings = static_cast<int>(residuals[at].size());
    if (sightings < kFewestOfAngle) continue;
    AngleResiduals one{(at + 0.5) * kDegreesEach, sightings};
    for (int q = 0; q < 3; ++q) one.quartiles[q] = Quantile(residuals[at], 0.25 * (q + 1));
    all.push_back(one);
  }
  return all;
}

}  // namespace nerf
