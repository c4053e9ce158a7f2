#include "nerf/inspect/geometry_verdicts.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <vector>

#include "nerf/config.h"
#include "nerf/data/camera.h"
#include "nerf/inspect/photograph_fit.h"
#include "sfm/scene_normalization.h"

namespace nerf {
namespace {

// From which on a scene calls for an effect.
constexpr double kFarAway = 0.007;      // share of points beyond kFar
constexpr double kFar = 8;              // radii of what the cameras look at
constexpr double kFewPhotographs = 15;  // before which a point stands
constexpr double kNearest = 0.01;       // share of sightings that may be nearer than "the nearest"
constexpr double kShareOfTheWay = 0.7;  // to them, in which nothing stands

}  // namespace

Verdict JudgeBackground(const sfm::PosedImages& posed) {
  const sfm::SceneNormalization normalized = sfm::NormalizeScene(posed);
  std::size_t far = 0;
  for (const sfm::SparsePoint& point : posed.points) {
    if (normalized.NormalizedFromWorld(point.x_in_world).norm() > kFar) ++far;
  }
  const double share = static_cast<double>(far) / static_cast<double>(posed.points.size());
  return Measured("background", share, kFarAway,
                  fmt::format("{:.1f} % of the points are more than {:.0f} radii away; {:.1f} % "
                              "call for it",
                              100 * share, kFar, 100 * kFarAway));
}

Verdict JudgeDepth(const sfm::PosedImages& posed) {
  std::vector<double> photographs;
  for (const sfm::SparsePoint& point : posed.points) {
    int before = 0;
    for (const sfm::PosedImage& image : posed.images) {
      const sfm::Camera& camera = posed.cameras[image.camera];
      const auto pixel =
          PixelFromPoint(camera, image.world_from_camera.inverse() * point.x_in_world);
      before += pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
                pixel->y() < camera.height;
    }
    photographs.push_back(before);
  }
  const double median = Quantile(photographs, 0.5);
  Verdict verdict =
      Fact("depth", median < kFewPhotographs, median,
           fmt::format("a point stands before {:.0f} photographs; fewer than {:.0f} call for it",
                       median, kFewPhotographs));
  verdict.threshold = kFewPhotographs;
  return verdict;
}

Verdict JudgeNear(const sfm::PosedImages& posed) {
  const sfm::SceneNormalization normalized = sfm::NormalizeScene(posed);
  std::vector<double> distances;
  for (const sfm::SparsePoint& point : posed.points) {
    for (const sfm::TrackElement& seen : point.track) {
      const Eigen::Vector3d camera = posed.images[seen.image].world_from_camera.translation();
      distances.push_back(normalized.scale * (point.x_in_world - camera).norm());
    }
  }
  const double nearest = Quantile(distances, kNearest);
  const double near = std::clamp(kShareOfTheWay * nearest, MarchOptions().near_distance, kFar);
  Verdict verdict = Fact("near", near > MarchOptions().near_distance, near,
                         fmt::format("the nearest points are {:.2f} radii before a camera, so rays "
                                     "begin at {:.2f}",
                                     nearest, near));
  verdict.assignment = fmt::format("{}={:.3f}", kNearKey, near);
  return verdict;
}

}  // namespace nerf
