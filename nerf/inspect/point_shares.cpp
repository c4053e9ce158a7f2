#include "nerf/inspect/point_shares.h"

#include <algorithm>
#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/scene/camera.h"

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

double SightedShare(const PosedImages& posed) {
  constexpr std::size_t kSample = 3000;  // points
  const std::size_t step = (posed.points.size() + kSample - 1) / kSample;
  std::vector<Eigen::Isometry3d> camera_from_world;
  for (const PosedImage& image : posed.images) {
    camera_from_world.push_back(image.world_from_camera.inverse());
  }
  std::vector<double> shares;
  for (std::size_t p = 0; p < posed.points.size(); p += step) {
    const SparsePoint& point = posed.points[p];
    int in_frame = 0;
    for (std::size_t i = 0; i < posed.images.size(); ++i) {
      const Camera& camera = posed.cameras[posed.images[i].camera];
      const auto pixel = PixelFromPoint(camera, camera_from_world[i] * point.x_in_world);
      in_frame += pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
                  pixel->y() < camera.height;
    }
    if (in_frame > 0) shares.push_back(static_cast<double>(point.track.size()) / in_frame);
  }
  return shares.empty() ? 0 : Median(shares);
}

bool IsBeforeBackground(const PointShares& shares) {
  return shares.far >= kFarAway && shares.between < kBetween && shares.far + shares.between < 1;
}

}  // namespace nerf
