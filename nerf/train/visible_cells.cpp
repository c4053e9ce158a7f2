#include "nerf/train/visible_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/sampling/contraction.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// A view with the cone around its axis that contains its frustum, which decides most cells quickly.
struct ViewCone {
  const View* view;
  Eigen::Isometry3d camera_from_normalized;
  double half_angle;  // radians
};

double HalfAngle(const Camera& camera) {
  double widest = 0;
  constexpr int kPointsOnAnEdge = 9;
  for (int i = 0; i < kPointsOnAnEdge; ++i) {
    const double u = camera.width * i / (kPointsOnAnEdge - 1.0);
    const double v = camera.height * i / (kPointsOnAnEdge - 1.0);
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(u, 0), Eigen::Vector2d(u, camera.height),
                                         Eigen::Vector2d(0, v), Eigen::Vector2d(camera.width, v)}) {
      const auto direction = DirectionFromPixel(camera, pixel);
      // A border outside the lens's field of view does not bound the angle: use the whole sphere.
      if (!direction) return std::numbers::pi;
      widest = std::max(widest, std::acos(std::clamp(direction->z(), -1.0, 1.0)));
    }
  }
  return widest;
}

// Whether a ball touches the frustum of a view.
bool Sees(const ViewCone& cone, const Eigen::Vector3d& x_in_normalized, double radius) {
  const Eigen::Vector3d x = cone.camera_from_normalized * x_in_normalized;
  const double distance = x.norm();
  if (distance <= radius) return true;
  const double angle = std::acos(std::clamp(x.z() / distance, -1.0, 1.0));
  if (angle > cone.half_angle + std::asin(radius / distance)) return false;
  const Camera& camera = cone.view->camera;
  const auto pixel = PixelFromPoint(camera, x);
  if (!pixel) return true;  // outside the lens's field of view, but the ball touches the cone
  const double margin = FocalLength(camera) * radius / distance + 1.0;
  return (*pixel)[0] > -margin && (*pixel)[0] < camera.width + margin && (*pixel)[1] > -margin &&
         (*pixel)[1] < camera.height + margin;
}

}  // namespace

void KeepVisibleCells(OccupancyGrid& grid, const std::vector<View>& views) {
  std::vector<ViewCone> cones;
  for (const View& view : views) {
    cones.push_back({&view, view.normalized_from_camera.inverse(), HalfAngle(view.camera)});
  }
  grid.KeepVisible([&](const Eigen::Vector3f& centre, float half_diagonal) {
    const Eigen::Vector3f y = ContractedFromUnitCube(centre);
    const Eigen::Vector3d x = Uncontract(y).cast<double>();
    // Outside the unit ball, inverting the contraction stretches most along the radius: by
    // 1 / (2 - |y|)^2.
    const double shrinkage = std::min(1.0, std::pow(2.0 - y.norm(), 2));
    const double radius = 4.0 * half_diagonal / std::max(shrinkage, 1e-6);
    return std::ranges::any_of(cones, [&](const ViewCone& c) { return Sees(c, x, radius); });
  });
}

}  // namespace nerf
