#include "nerf/transport/pixel_rays.h"

#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/scene/camera.h"

namespace nerf {

using Eigen::Vector2d;

Ray RayThroughPixel(const Camera& camera, const Eigen::Isometry3d& world_from_camera,
                    const Vector2d& pixel) {
  const auto direction_in_camera = DirectionFromPixel(camera, pixel);
  if (!direction_in_camera) {
    throw InputError("the camera has no ray for pixel ({}, {}): choose another lens", pixel.x(),
                     pixel.y());
  }
  return {world_from_camera.translation(), world_from_camera.linear() * *direction_in_camera};
}

Vector2d PointInPixel(int i, const Vector2d& shift) {
  const double x = shift.x() + 0.7548776662466927 * i;
  const double y = shift.y() + 0.5698402909980532 * i;
  return {x - std::floor(x), y - std::floor(y)};
}

}  // namespace nerf
