#include "nerf/effects/near_plane.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/inspect/point_shares.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {
namespace {

constexpr double kNearest = 0.01;         // quantile of distances that counts as the nearest
constexpr double kNearPlaneFactor = 0.7;  // near plane over the distance of the nearest points

}  // namespace

Verdict JudgeNearPlane(const PosedImages& posed, const SceneNormalization& normalized_from_world) {
  std::vector<double> distances;
  for (const SparsePoint& point : posed.points) {
    for (const TrackElement& seen : point.track) {
      const Eigen::Vector3d camera = posed.images[seen.image].world_from_camera.translation();
      distances.push_back(normalized_from_world.scale * (point.x_in_world - camera).norm());
    }
  }
  const double nearest = Quantile(distances, kNearest);
  const double near =
      std::clamp(kNearPlaneFactor * nearest, MarchOptions().near_distance, kFarRadius);
  Verdict verdict = Fact(kNearPlane, near > MarchOptions().near_distance, near,
                         fmt::format("the nearest points are {:.2f} radii from a camera, so rays "
                                     "begin at {:.2f}",
                                     nearest, near));
  verdict.assignment = fmt::format("{}={:.3f}", kNearKey, near);
  return verdict;
}

}  // namespace nerf
