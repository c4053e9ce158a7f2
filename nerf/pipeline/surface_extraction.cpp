#include "nerf/pipeline/surface_extraction.h"

#include <array>

#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"
#include "nerf/geometry/surface_mesh.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/depth_fusion.h"

namespace nerf {
namespace {

constexpr float kOpaqueDepth = 0.5f;
// The box leaves out this share of the points at each of its sides: stray ones.
constexpr double kStray = 0.001;
constexpr std::size_t kFewestPoints = 100;

// The points of opaque pixels within the unit ball.
void AddPoints(const DepthMap& view, std::array<std::vector<double>, 3>& coordinates) {
  for (int y = 0; y < view.camera.height; ++y) {
    for (int x = 0; x < view.camera.width; ++x) {
      if (*view.opacity.At(x, y) < kOpaqueDepth) continue;
      const auto direction = DirectionFromPixel(view.camera, {x + 0.5, y + 0.5});
      if (!direction) continue;
      const Eigen::Vector3d point =
          view.grid_from_camera * (static_cast<double>(*view.distance.At(x, y)) * *direction);
      if (point.norm() > 1) continue;
      for (int k = 0; k < 3; ++k) coordinates[k].push_back(point[k]);
    }
  }
}

FusionBox BoxOf(const std::vector<DepthMap>& views, const SurfaceExtractionOptions& options) {
  std::array<std::vector<double>, 3> coordinates;
  for (const DepthMap& view : views) AddPoints(view, coordinates);
  if (coordinates[0].size() < kFewestPoints) {
    throw InputError(
        "nothing of the scene is opaque within the unit ball about what the cameras look at, so it "
        "has no surface; train longer");
  }
  FusionBox where;
  for (int k = 0; k < 3; ++k) {
    where.box.min()[k] = Quantile(coordinates[k], kStray);
    where.box.max()[k] = Quantile(coordinates[k], 1 - kStray);
  }
  where.cell = where.box.sizes().maxCoeff() / options.resolution;
  where.truncation = options.truncation;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(2 * options.truncation * where.cell);
  where.box.min() -= margin;
  where.box.max() += margin;
  return where;
}

}  // namespace

std::optional<ExtractedSurface> ExtractSurface(const SceneModel& model,
                                               const std::vector<TargetView>& views,
                                               const SurfaceExtractionOptions& options,
                                               const std::atomic<bool>& stop,
                                               const std::function<void(std::size_t)>& progress) {
  const SceneNormalization& frame = model.Scene().normalized_from_world;
  std::vector<DepthMap> depths;
  for (const TargetView& view : views) {
    RenderedView rendered =
        model.Render({view.camera, frame.WorldFromCamera(view.normalized_from_camera)});
    depths.push_back({view.camera, view.normalized_from_camera, std::move(rendered.depth),
                      std::move(rendered.opacity)});
    progress(depths.size());
    if (stop) return std::nullopt;
  }
  ExtractedSurface surface;
  surface.distance = FuseDepth(depths, BoxOf(depths, options));
  Blur(surface.distance, options.blur);
  surface.mesh = SurfaceMesh(surface.distance);
  return surface;
}

}  // namespace nerf
