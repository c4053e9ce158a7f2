#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "nerf/geometry/shape_list.h"
#include "nerf/light/environment_map.h"
#include "nerf/light/lights.h"
#include "nerf/material/brdf.h"
#include "nerf/transport/subsurface.h"

namespace nerf {

// Materials that alternate over a surface: a texture of whole BRDFs.
struct BrdfPattern {
  std::vector<std::shared_ptr<const Brdf>> brdfs;
  // The index of that at a point in the frame of the shape (ShapeFromWorld).
  std::function<std::size_t(const Eigen::Vector3d& x_in_shape)> index;
};

// A surface with its material. Both sides of a disc, and the inside of boxes and spheres, reflect
// as the outside does.
struct Surface {
  Shape shape;
  std::shared_ptr<const Brdf> brdf = nullptr;            // nullptr: reflects nothing
  Color emission = Color::Zero();                        // radiance, in all directions
  std::shared_ptr<const BrdfPattern> pattern = nullptr;  // in place of brdf; nullptr: none
  // Subsurface scattering, for a sphere that must equal `shape`; nullptr: none. The boundary itself
  // reflects only if there is a brdf.
  std::shared_ptr<const SubsurfaceSphere> subsurface = nullptr;
};

// A scene of analytic surfaces and its lights.
struct SurfaceScene {
  std::vector<Surface> surfaces;
  std::vector<DirectionalLight> directional_lights;
  std::vector<PointLight> point_lights;
  std::shared_ptr<const EnvironmentMap> environment;  // nullptr: black
};

using SurfaceHit = Hit<Surface>;

// The BRDF at a point of a surface; nullptr: it reflects nothing.
inline const Brdf* BrdfAt(const Surface& surface, const Eigen::Vector3d& x_in_world) {
  if (!surface.pattern) return surface.brdf.get();
  const std::size_t index = surface.pattern->index(ShapeFromWorld(surface.shape, x_in_world));
  return surface.pattern->brdfs.at(index).get();
}

}  // namespace nerf
