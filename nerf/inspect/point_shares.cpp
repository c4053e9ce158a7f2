#include "nerf/inspect/point_shares.h"

#include <algorithm>
#include <vector>

namespace nerf {
namespace {

constexpr double kBetween = 0.005;  // share of points that may stand before a background
constexpr double kMargin = 1.2;     // about the near points, for matter that has no points

}  // namespace

PointShares SharesOfPoints(const PosedImages& posed,
                           const SceneNormalization& normalized_from_world) {
  PointShares shares;
  std::vector<Eigen::Vector3d> near;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kFarRadius), high = -low;
  const double each = 1 / static_cast<double>(posed.points.size());
  for (const SparsePoint& point : posed.points) {
    const Eigen::Vector3d x = normalized_from_world.NormalizedFromWorld(point.x_in_world);
    if (x.norm() > kFarRadius) {
      shares.far += each;
    } else if (x.norm() > kNearRadius) {
      shares.between += each;
    } else {
      near.push_back(x);
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  if (near.empty()) return shares;
  shares.near = {(low + high) / 2, 0};
  for (const Eigen::Vector3d& x : near) {
    shares.near.radius = std::max(shares.near.radius, kMargin * (x - shares.near.centre).norm());
  }
  return shares;
}

bool IsBeforeBackground(const PointShares& shares) {
  return shares.far >= kFarAway && shares.between < kBetween && shares.far + shares.between < 1;
}

}  // namespace nerf
