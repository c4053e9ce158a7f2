#pragma once

#include <memory>
#include <vector>

#include "nerf/geometry/shape_list.h"
#include "nerf/light/environment_map.h"
#include "nerf/light/lights.h"
#include "nerf/material/brdf.h"
#include "nerf/transport/subsurface.h"

namespace nerf {

// A surface with its material. Both sides of a disc, and the inside of boxes and spheres, reflect
// as the outside does.
struct Surface {
  Shape shape;
  std::shared_ptr<const Brdf> brdf = nullptr;  // nullptr: reflects nothing
  Color emission = Color::Zero();              // radiance, in all directions
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

}  // namespace nerf
