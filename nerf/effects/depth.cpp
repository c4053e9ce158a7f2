#include "nerf/effects/depth.h"

#include <cmath>
#include <map>
#include <string>

#include "nerf/data/camera.h"

namespace nerf {
namespace {

// Points that are known well enough.
constexpr std::size_t kFewestSightings = 3;
constexpr double kLargestError = 2;  // pixels

}  // namespace

void AddSeenPoints(const sfm::PosedImages& sparse,
                   const sfm::SceneNormalization& normalized_from_world, Dataset& data) {
  std::map<std::string, View*> views;
  for (View& view : data.train) views[view.name] = &view;
  for (const sfm::SparsePoint& point : sparse.points) {
    if (point.track.size() < kFewestSightings || point.reprojection_error > kLargestError) continue;
    const Eigen::Vector3d x = normalized_from_world.NormalizedFromWorld(point.x_in_world);
    for (const sfm::TrackElement& seen : point.track) {
      const auto found = views.find(sparse.images[seen.image].name);
      if (found == views.end()) continue;
      View& view = *found->second;
      const Eigen::Vector3d x_in_camera = view.normalized_from_camera.inverse() * x;
      const auto pixel = PixelFromPoint(view.camera, x_in_camera);
      if (!pixel || pixel->x() < 0 || pixel->y() < 0) continue;
      const auto column = static_cast<std::int64_t>(pixel->x());
      const auto row = static_cast<std::int64_t>(pixel->y());
      if (column >= view.camera.width || row >= view.camera.height) continue;
      view.points.push_back(
          {row * view.camera.width + column, static_cast<float>(x_in_camera.norm())});
    }
  }
}

DepthCost CostOfDepth(double distance, double target, const DepthOptions& options) {
  const double error = distance / target - 1, size = std::fabs(error), delta = options.delta;
  if (size <= delta) return {0.5 * error * error / delta, error / (delta * target)};
  return {size - 0.5 * delta, (error > 0 ? 1.0 : -1.0) / target};
}

torch::Tensor DepthLoss(const torch::Tensor& distance, const torch::Tensor& target,
                        const DepthOptions& options) {
  TORCH_CHECK(distance.sizes() == target.sizes(), "DepthLoss: distance ", distance.sizes(),
              " and target ", target.sizes(), " differ in shape");
  const torch::Tensor known = target > 0;
  // Where there is no target, any number but 0 will do: a division by it must not spoil gradients.
  const torch::Tensor error = distance / torch::where(known, target, torch::ones_like(target)) - 1;
  const torch::Tensor cost =
      torch::huber_loss(error, torch::zeros_like(error), at::Reduction::None, options.delta) /
      options.delta;
  return options.weight * torch::where(known, cost, torch::zeros_like(cost)).mean();
}

}  // namespace nerf
