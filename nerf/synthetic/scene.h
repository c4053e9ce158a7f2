#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "nerf/geometry/shape_list.h"
#include "nerf/light/lights.h"
#include "nerf/synthetic/texture.h"

namespace nerf::synthetic {

// A diffuse (Lambert) base under a mirroring coat.
struct Material {
  Texture albedo;                   // of the base
  Color mirror = Color::Zero();     // reflectance of the coat at normal incidence; 0: no coat
  double highlight_exponent = 400;  // of the Phong lobe in which coat and gloss reflect the sun
  Color gloss = Color::Zero();      // fraction of the light that the base reflects in that lobe
                                    // instead of diffusely; only the sun is reflected so
};

struct Object {
  Shape shape;
  Material material;
};

// Ambient radiance, the same everywhere: `above` on surfaces that face up, `below` on those that
// face down, interpolated between. A surface of albedo a that faces up reflects a * above.
struct Ambient {
  Color above = Color::Zero();
  Color below = Color::Zero();
};

// A glowing sphere about the origin that encloses everything: the background of camera and mirrors.
// It lights nothing and casts no shadow.
struct Dome {
  double radius = 8;
  Texture radiance;  // of the direction from the origin
};

// World: z up, units about metres. See ray_tracer.h for the shading.
struct Scene {
  std::vector<Object> objects;
  DirectionalLight sun{Eigen::Vector3d::UnitZ(), Color::Zero()};
  Ambient ambient;
  std::optional<Dome> dome;
};

// A marble ball, a mosaic tower, a block, a small ball and a mirroring golden ball, all within
// about a unit of the origin, on a slab of terrazzo in the sand, in the sun under a cloudy sky.
Scene BuiltInScene();

}  // namespace nerf::synthetic
