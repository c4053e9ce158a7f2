#pragma once

#include <optional>

#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {

// Shading of the generated captures: recursive mirrors (Whitted 1980), hard shadows, an ambient
// term instead of indirect light. It shares shapes and intersections with the path tracer of
// nerf/transport, but not its SurfaceScene: textures, ambient light and the dome that lights
// nothing have no counterpart there, and these captures must be noise-free with one ray a sample.

// The closest hit of a ray.
struct SceneHit {
  double distance = 0;  // along the ray, scene units
  Eigen::Vector3d x_in_world;
  Eigen::Vector3d normal_in_world;     // unit, on the side that the ray comes from
  Color albedo;                        // of the base; the radiance of the dome
  const Material* material = nullptr;  // nullptr on the dome
};

// The first surface along a ray, including the dome.
//   returns  nullopt if there is none; under a dome this happens only to rays from outside it
std::optional<SceneHit> Trace(const Scene& scene, const Ray& ray);

// Whether the sun lights a point of a surface with this normal: it is not in shadow and does not
// face away.
bool SunReaches(const Scene& scene, const Eigen::Vector3d& x_in_world,
                const Eigen::Vector3d& normal_in_world);

// The radiance that arrives at the origin of a ray, in units in which a white surface under an
// ambient radiance of 1 is 1.
//   surface  L = (1 - F) base + F L(mirrored ray) + F E cos lobe
//   base     (1 - gloss) albedo (ambient + E cos / pi) + gloss E cos lobe
//   F        Schlick 1994; lobe: Phong, normalised (Lafortune and Willems 1994)
//   bounces  number of mirror reflections; beyond them a coat reflects nothing but the sun
Color Radiance(const Scene& scene, const Ray& ray, int bounces);

}  // namespace nerf::synthetic
