#pragma once

#include <memory>
#include <vector>

#include "nerf/geometry/shape_list.h"
#include "nerf/light/environment_map.h"
#include "nerf/light/lights.h"
#include "nerf/material/brdf.h"
#include "nerf/transport/subsurface.h"

namespace nerf {

// A surface and what it does with light. Boxes and discs have two sides that are alike.
struct Surface {
  Shape shape;
  std::shared_ptr<const Brdf> brdf = nullptr;  // none: reflects nothing
  Color emission = Color::Zero();              // radiance, to all sides
  // Light that enters a translucent sphere, the same as `shape`, and leaves it elsewhere; none:
  // no light does. Its boundary mirrors nothing unless there is a brdf for that.
  std::shared_ptr<const SubsurfaceSphere> subsurface = nullptr;
};

// A scene of analytic surfaces in the light.
struct SurfaceScene {
  std::vector<Surface> surfaces;
  std::vector<DirectionalLight> directional_lights;
  std::vector<PointLight> point_lights;
  std::shared_ptr<const EnvironmentMap> environment;  // nullptr: darkness
};

using SurfaceHit = Hit<Surface>;

}  // namespace nerf
