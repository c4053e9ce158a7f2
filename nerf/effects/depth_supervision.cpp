#include "nerf/effects/depth_supervision.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <map>
#include <string>

#include "nerf/base/quantile.h"
#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Points that are accurate enough.
constexpr std::size_t kFewestSightings = 3;
constexpr double kLargestError = 2;  // reprojection error, pixels

constexpr double kFewPhotographs = 15;  // threshold: photographs with a point in view, median

}  // namespace

void AddSparseDepths(const PosedImages& sparse, const SceneNormalization& normalized_from_world,
                     Dataset& data) {
  std::map<std::string, View*> views;
  for (View& view : data.train) {
    views[view.name] = &view;
    view.depth_observations.clear();
  }
  for (const SparsePoint& point : sparse.points) {
    if (point.track.size() < kFewestSightings || point.reprojection_error > kLargestError) continue;
    const Eigen::Vector3d x = normalized_from_world.NormalizedFromWorld(point.x_in_world);
    for (const TrackElement& seen : point.track) {
      const auto found = views.find(sparse.images[seen.image].name);
      if (found == views.end()) continue;
      View& view = *found->second;
      const Eigen::Vector3d x_in_camera = view.normalized_from_camera.inverse() * x;
      const auto pixel = PixelFromPoint(view.camera, x_in_camera);
      if (!pixel || pixel->x() < 0 || pixel->y() < 0) continue;
      const auto column = static_cast<std::int64_t>(pixel->x());
      const auto row = static_cast<std::int64_t>(pixel->y());
      if (column >= view.camera.width || row >= view.camera.height) continue;
      view.depth_observations.push_back(
          {row * view.camera.width + column, static_cast<float>(x_in_camera.norm())});
    }
  }
}

double DepthCost(double t, double target, const DepthSupervisionOptions& options) {
  const double error = t / target - 1, square = error * error;
  return square / (square + options.delta * options.delta);
}

std::vector<float> DepthCosts(std::span<const float> t, std::span<const std::int64_t> ray,
                              std::span<const float> target,
                              const DepthSupervisionOptions& options) {
  std::vector<float> costs(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto of_ray = static_cast<double>(target[ray[i]]);
    if (of_ray == 0) continue;
    costs[i] = static_cast<float>(DepthCost(static_cast<double>(t[i]), of_ray, options));
  }
  return costs;
}

Verdict JudgeDepthSupervision(const PosedImages& posed,
                              const SceneNormalization& normalized_from_world) {
  std::vector<double> photographs;
  for (const SparsePoint& point : posed.points) {
    if (normalized_from_world.NormalizedFromWorld(point.x_in_world).norm() > kFarRadius) continue;
    int count = 0;
    for (const PosedImage& image : posed.images) {
      const Camera& camera = posed.cameras[image.camera];
      const auto pixel =
          PixelFromPoint(camera, image.world_from_camera.inverse() * point.x_in_world);
      count += pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
               pixel->y() < camera.height;
    }
    photographs.push_back(count);
  }
  if (photographs.empty())
    return Undecided(kDepthSupervisionEffect.name, "all points are far away");
  const double median = Quantile(photographs, 0.5);
  Verdict verdict =
      Fact(kDepthSupervisionEffect.name, median < kFewPhotographs, median,
           fmt::format("a point is in view of {:.0f} photographs (threshold: fewer than {:.0f})",
                       median, kFewPhotographs));
  verdict.threshold = kFewPhotographs;
  return verdict;
}

const EffectDescriptor kDepthSupervisionEffect = {
    .name = "depth_supervision",
    .old_name = "depth",
    .help = "for few photographs: rays through sparse points must end there",
    .stage = "loss",
    .judge =
        [](const CaptureEvidence& e) {
          return e.HasTracks() ? JudgeDepthSupervision(*e.posed, e.frame)
                               : Undecided(kDepthSupervisionEffect.name, e.unknown_because);
        },
};

}  // namespace nerf
