#include "nerf/effects/near_plane.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {
namespace {

constexpr double kNearest = 0.01;       // share of sightings that may be nearer than "the nearest"
constexpr double kShareOfTheWay = 0.7;  // to them, in which nothing stands

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
      std::clamp(kShareOfTheWay * nearest, MarchOptions().near_distance, kFarRadius);
  Verdict verdict = Fact(kNearPlane, near > MarchOptions().near_distance, near,
                         fmt::format("the nearest points are {:.2f} radii before a camera, so rays "
                                     "begin at {:.2f}",
                                     nearest, near));
  verdict.assignment = fmt::format("{}={:.3f}", kNearKey, near);
  return verdict;
}

}  // namespace nerf
