#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "nerf/geometry/shape_list.h"
#include "nerf/light/lights.h"
#include "nerf/synthetic/texture.h"

namespace nerf::synthetic {

// What a surface does with light: a diffuse (Lambert) base under a coat that reflects.
struct Material {
  Texture albedo;                   // of the base
  Color mirror = Color::Zero();     // reflectance of the coat at normal incidence; 0: no coat
  double highlight_exponent = 400;  // of the Phong lobe in which coat and gloss show the sun
  Color gloss = Color::Zero();      // part of the light that the base reflects not evenly but in
                                    // that lobe: rough, so that it shows the sun and nothing else
};

struct Object {
  Shape shape;
  Material material;
};

// Light that reaches a surface wherever it is: `above` where it faces up, `below` where it faces
// down, a mixture between. Radiance; a surface of albedo a that faces up reflects a * above.
struct Ambient {
  Color above = Color::Zero();
  Color below = Color::Zero();
};

// A luminous sphere about the origin that encloses everything. It lights nothing and casts no
// shadow; it is what the camera and the mirrors see where nothing else is.
struct Dome {
  double radius = 8;
  Texture radiance;  // of the direction from the origin
};

// World: z up, units about metres.
struct Scene {
  std::vector<Object> objects;
  DirectionalLight sun{Eigen::Vector3d::UnitZ(), Color::Zero()};
  Ambient ambient;
  std::optional<Dome> dome;
};

// The sample's scene: a marble ball, a mosaic tower, a block, a small ball and a golden ball that
// mirrors them, all within about a unit of the origin, on a slab of terrazzo in the sand, in the
// sun under a cloudy sky.
Scene BuiltInScene();

}  // namespace nerf::synthetic
