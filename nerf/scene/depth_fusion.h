#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "nerf/geometry/scalar_grid.h"
#include "nerf/image/image.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// The distances that one camera sees, in the frame and units of the grid.
struct DepthMap {
  Camera camera;
  Eigen::Isometry3d grid_from_camera;
  Image distance;  // 1 channel, along the ray; where opacity is below 1/2 it is ignored
  Image opacity;   // 1 channel, in [0,1]
};

// The space in which surfaces are looked for.
struct FusionBox {
  Eigen::AlignedBox3d box;
  double cell = 0.01;     // side
  double truncation = 3;  // cells: farther behind a surface a view says nothing
};

// A signed distance to the surfaces that depth pictures agree on, in units of `truncation` cells,
// within [-1, 1], positive outside: the mean over the views that see a point, or the space not far
// behind a surface. What a view sees beside a silhouette is no farther from the surface than from
// the silhouette. What no view says anything about is inside: -1.
// Source: Curless and Levoy 1996, "A Volumetric Method for Building Complex Models from Range
// Images", with equal weights. (To weight views by the cosine at which they see a surface makes the
// normals of noisy depth worse.)
ScalarGrid FuseDepth(const std::vector<DepthMap>& views, const FusionBox& where);

}  // namespace nerf
