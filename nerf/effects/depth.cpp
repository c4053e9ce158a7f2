#include "nerf/effects/depth.h"

#include <cmath>
#include <map>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Points that are known well enough.
constexpr std::size_t kFewestSightings = 3;
constexpr double kLargestError = 2;  // pixels

}  // namespace

void DepthOptions::Check() const {
  if (!(share >= 0 && share <= 0.5)) {
    throw InputError("config: effects.depth.share is {}; use 0 to 0.5", share);
  }
  if (!(weight >= 0)) {
    throw InputError("config: effects.depth.weight is {}; use 0 or more", weight);
  }
  if (!(delta > 0)) {
    throw InputError("config: effects.depth.delta is {}; use more than 0", delta);
  }
}

void AddSeenPoints(const PosedImages& sparse, const SceneNormalization& normalized_from_world,
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

double CostOfDistance(double t, double target, const DepthOptions& options) {
  const double error = t / target - 1, square = error * error;
  return square / (square + options.delta * options.delta);
}

std::vector<float> CostsOfSamples(std::span<const float> t, std::span<const std::int64_t> ray,
                                  std::span<const float> target, const DepthOptions& options) {
  std::vector<float> costs(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto of_ray = static_cast<double>(target[ray[i]]);
    if (of_ray == 0) continue;
    costs[i] = static_cast<float>(CostOfDistance(static_cast<double>(t[i]), of_ray, options));
  }
  return costs;
}

}  // namespace nerf
