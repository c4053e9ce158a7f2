#pragma once

#include <optional>

#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {

// What a ray meets first.
struct SceneHit {
  double distance = 0;  // along the ray, scene units
  Eigen::Vector3d x_in_world;
  Eigen::Vector3d normal_in_world;     // unit, on the side the ray comes from
  Color albedo;                        // of the base; on the dome its radiance
  const Material* material = nullptr;  // nullptr on the dome
};

// First surface along a ray, the dome included.
//   returns  nullopt where there is none, which under a dome happens only to rays from outside it
std::optional<SceneHit> Trace(const Scene& scene, const Ray& ray);

// Whether the sun reaches a point on a surface with this normal: nothing stands between, and the
// surface does not face away.
bool SunReaches(const Scene& scene, const Eigen::Vector3d& x_in_world,
                const Eigen::Vector3d& normal_in_world);

// Radiance that arrives at the origin of a ray, linear RGB, in units where an ambient radiance of 1
// makes a white surface 1.
//   surface  L = (1 - F) base + F L(mirrored ray) + F E cos lobe
//   base     (1 - gloss) albedo (ambient + E cos / pi) + gloss E cos lobe
//   F        Schlick 1994; lobe: Phong, normalised (Lafortune and Willems 1994)
//   bounces  how many mirrors a path may meet; beyond them a coat reflects nothing
Color Radiance(const Scene& scene, const Ray& ray, int bounces);

}  // namespace nerf::synthetic
