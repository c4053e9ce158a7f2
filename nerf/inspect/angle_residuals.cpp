#include "nerf/inspect/angle_residuals.h"

#include <cmath>
#include <numbers>

#include "nerf/base/quantile.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

constexpr double kDegreesPerBin = 5;
constexpr int kBins = 36;                             // 0 to 180 degrees
constexpr int kFewestOfPoint = 5, kFewestInBin = 30;  // sightings

// From a point to the camera of a photograph that observes it.
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
  std::vector<std::vector<double>> residuals(kBins);
  for (std::size_t i = 0; i < colors.seen.size(); ++i) {
    const Sighting& s = colors.seen[i];
    if (count[s.point] < kFewestOfPoint) continue;
    const Vector3d direction = DirectionToCamera(posed, s), mean = sum[s.point];
    const double radians = std::atan2(direction.cross(mean).norm(), direction.dot(mean));
    const auto bin = static_cast<int>(radians * 180 / std::numbers::pi / kDegreesPerBin);
    const auto residual = static_cast<double>(std::fabs(fit.residuals[i].mean()));
    residuals[std::min(bin, kBins - 1)].push_back(
        residual / (kTexturelessVariation + static_cast<double>(s.contrast)));
  }
  std::vector<AngleResiduals> all;
  for (int bin = 0; bin < kBins; ++bin) {
    const auto sightings = static_cast<int>(residuals[bin].size());
    if (sightings < kFewestInBin) continue;
    AngleResiduals of_bin{(bin + 0.5) * kDegreesPerBin, sightings};
    for (int q = 0; q < 3; ++q) of_bin.quartiles[q] = Quantile(residuals[bin], 0.25 * (q + 1));
    all.push_back(of_bin);
  }
  return all;
}

}  // namespace nerf
