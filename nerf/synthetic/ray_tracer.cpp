#include "nerf/synthetic/ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/material/microfacet.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;

Vector3d Mirrored(const Vector3d& direction, const Vector3d& normal) {
  return direction - 2 * direction.dot(normal) * normal;
}

std::optional<SceneHit> TraceDome(const Dome& dome, const Ray& ray) {
  const auto crossing = Intersect(Sphere{Vector3d::Zero(), dome.radius}, ray, kMinHitDistance);
  if (!crossing) return std::nullopt;
  SceneHit hit;
  hit.distance = crossing->distance;
  hit.x_in_world = ray.origin_in_world + hit.distance * ray.direction_in_world;
  hit.normal_in_world = -crossing->normal_in_world;
  if (hit.normal_in_world.dot(ray.direction_in_world) > 0) return std::nullopt;  // from outside
  hit.albedo = Evaluate(dome.radiance, crossing->normal_in_world);
  return hit;
}

// The highlight of the sun on a perfect reflector; 0 in shadow.
Color Highlight(const Scene& scene, const Ray& ray, const SceneHit& hit, bool in_sun) {
  if (!in_sun) return Color::Zero();
  const Vector3d mirrored = Mirrored(ray.direction_in_world, hit.normal_in_world);
  const double n = hit.material->highlight_exponent;
  const double cosine = std::max(0.0, mirrored.dot(scene.sun.to_light));
  const double lobe = std::pow(cosine, n) * (n + 2) / (2 * std::numbers::pi);
  return scene.sun.irradiance * lobe * hit.normal_in_world.dot(scene.sun.to_light);
}

// What the coat reflects: the mirrored scene, and the highlight of the sun.
Color CoatRadiance(const Scene& scene, const Ray& ray, const SceneHit& hit, bool in_sun,
                   int bounces) {
  const Ray mirrored{hit.x_in_world, Mirrored(ray.direction_in_world, hit.normal_in_world)};
  Color radiance = Highlight(scene, ray, hit, in_sun);
  if (bounces > 0) radiance += Radiance(scene, mirrored, bounces - 1);
  return radiance;
}

}  // namespace

std::optional<SceneHit> Trace(const Scene& scene, const Ray& ray) {
  const auto nearest = FirstHit(scene.objects, ray);
  // All objects are inside the dome, so a hit on an object is closer than one on the dome.
  if (!nearest) return scene.dome ? TraceDome(*scene.dome, ray) : std::nullopt;
  const Object& object = *nearest->item;
  return SceneHit{
      nearest->distance, nearest->x_in_world, nearest->normal_in_world,
      Evaluate(object.material.albedo, ShapeFromWorld(object.shape, nearest->x_in_world)),
      &object.material};
}

bool SunReaches(const Scene& scene, const Vector3d& x_in_world, const Vector3d& normal_in_world) {
  if (normal_in_world.dot(scene.sun.to_light) <= 0) return false;
  return !IsBlocked(scene.objects, {x_in_world, scene.sun.to_light});
}

Color Radiance(const Scene& scene, const Ray& ray, int bounces) {
  const std::optional<SceneHit> hit = Trace(scene, ray);
  if (!hit) return Color::Zero();
  if (hit->material == nullptr) return hit->albedo;

  const Vector3d& normal = hit->normal_in_world;
  const double up = 0.5 + 0.5 * normal.z();
  Color light = scene.ambient.below + (scene.ambient.above - scene.ambient.below) * up;
  const bool in_sun = SunReaches(scene, hit->x_in_world, normal);
  if (in_sun) {
    light += scene.sun.irradiance * normal.dot(scene.sun.to_light) / std::numbers::pi;
  }
  const Color& gloss = hit->material->gloss;
  Color base = hit->albedo * light;
  if (!gloss.isZero(0)) {
    base = (1 - gloss) * base + gloss * Highlight(scene, ray, *hit, in_sun);
  }
  if (hit->material->mirror.isZero(0)) return base;

  const Color F = SchlickFresnel(hit->material->mirror, -normal.dot(ray.direction_in_world));
  const Color coat = CoatRadiance(scene, ray, *hit, in_sun, bounces);
  return (1 - F) * base + F * coat;
}

}  // namespace nerf::synthetic
