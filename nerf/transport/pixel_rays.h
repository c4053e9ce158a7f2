#pragma once

#include <Eigen/Geometry>

#include "nerf/geometry/shapes.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// The ray from a camera through a point of its picture.
//   pixel  centres of pixels lie at +0.5
// Throws InputError if the lens has no ray there.
Ray RayThroughPixel(const Camera& camera, const Eigen::Isometry3d& world_from_camera,
                    const Eigen::Vector2d& pixel);

// The i-th point of a sequence that fills the unit square evenly, however many are taken.
// Source: Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences" (R2), with the
// shift of Cranley and Patterson 1976.
Eigen::Vector2d PointInPixel(int i, const Eigen::Vector2d& shift);

}  // namespace nerf
