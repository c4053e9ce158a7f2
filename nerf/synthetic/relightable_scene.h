#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "nerf/transport/surface_scene.h"

namespace nerf::synthetic {

// The true material at a point.
struct TrueMaterial {
  Color base_color = Color::Zero();
  double roughness = 1;
  double metallic = 0;
};

// A scene with known materials: balls, boxes and a slab, of roughness 0.2 to 0.9, two of them with
// textures, one of metal; they shadow each other and reflect light to each other. z is up.
struct RelightableScene {
  SurfaceScene scene;  // without lights
  // Of each surface, in the same order: its materials, one, or those of its pattern.
  std::vector<std::vector<TrueMaterial>> materials;

  const TrueMaterial& MaterialAt(const SurfaceHit& hit) const;
};
RelightableScene MakeRelightableScene();

// A built-in light: radiance by the direction in the world, in which z is up.
struct BuiltInLight {
  std::string name;
  std::function<Color(const Eigen::Vector3d& direction)> radiance;
};
// A sky with a low sun, a room with two lamps, and an overcast sky.
std::vector<BuiltInLight> BuiltInLights();

// A map of a light, in the axes of the path tracer: those of the world.
EnvironmentMap MapInWorld(const BuiltInLight& light, int height);
// The same as it is written to a file: the top row is +z, the centre +x (MapFromZUpWorld).
Image MapInFile(const BuiltInLight& light, int height);

}  // namespace nerf::synthetic
