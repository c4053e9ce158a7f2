#include "nerf/transport/path_tracer.h"

#include <cmath>
#include <limits>

#include "nerf/base/input_error.h"
#include "nerf/geometry/directions.h"

namespace nerf {

using Eigen::Vector3d;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr int kEnvironmentSamples = 2048;                   // at each point of a translucent sphere
constexpr std::uint64_t kTranslucent = 0x7472616e736c7563;  // a separate random stream

double PowerHeuristic(double pdf, double other) {
  const double a = pdf * pdf;
  return a > 0 ? a / (a + other * other) : 0;
}

bool IsLit(const SurfaceScene& scene) {
  return !scene.directional_lights.empty() || !scene.point_lights.empty() || scene.environment;
}

}  // namespace

// A surface point on a path, with the frame of its BRDF.
struct PathTracer::Vertex {
  explicit Vertex(const SurfaceHit& surface_hit, const Vector3d& towards_viewer)
      : hit(surface_hit),
        world_from_surface(WorldFromSurface(surface_hit.normal_in_world)),
        w_o(world_from_surface.transpose() * towards_viewer) {}

  const SurfaceHit& hit;
  Eigen::Matrix3d world_from_surface;
  Vector3d w_o;  // in the surface's frame

  Vector3d ToSurface(const Vector3d& in_world) const {
    return world_from_surface.transpose() * in_world;
  }
};

void TransportTerms::Check() const {
  if (bounces < 0 || bounces > 100) {
    throw InputError("--bounces is {}: choose a number from 0 to 100", bounces);
  }
}

PathTracer::PathTracer(const SurfaceScene& scene, const TransportTerms& terms, std::uint64_t seed)
    : scene_(scene), terms_(terms) {
  terms.Check();
  for (const Surface& surface : scene.surfaces) {
    has_emitters_ = has_emitters_ || !surface.emission.isZero(0);
    if (!surface.subsurface || !terms.direct || !IsLit(scene)) continue;
    const Dipole& dipole = surface.subsurface->dipole();
    exitance_[&surface] = SubsurfaceSphere::Illuminate(
        surface.subsurface, [&](int point, const Vector3d& x, const Vector3d& normal) -> Color {
          const SurfaceHit hit{&surface, 0, x, normal};
          const Vertex vertex(hit, normal);
          std::int64_t rays = 0;
          Color sum = Color::Zero();
          const auto add = [&](const Vector3d& to_light, double distance, const Color& light) {
            const double cosine = normal.dot(to_light);
            if (cosine <= 0 || !IsUnoccluded(vertex, to_light, distance, rays)) return;
            sum += light * (cosine * dipole.Transmittance(cosine));
          };
          for (const auto& light : scene_.directional_lights) {
            add(light.to_light, kFar, light.irradiance);
          }
          for (const auto& light : scene_.point_lights) {
            const IncidentLight incident = IncidentFrom(light, x);
            add(incident.to_light, incident.distance, incident.irradiance);
          }
          if (scene_.environment) {
            UniformStream random(seed, kTranslucent, static_cast<std::uint64_t>(point));
            for (int i = 0; i < kEnvironmentSamples; ++i) {
              const auto drawn = scene_.environment->Sample(random.Next2());
              if (!drawn) break;
              add(drawn->direction, kFar, drawn->radiance / (drawn->pdf * kEnvironmentSamples));
            }
          }
          return sum;
        });
  }
}

bool PathTracer::IsUnoccluded(const Vertex& vertex, const Vector3d& direction, double distance,
                              std::int64_t& rays) const {
  if (!terms_.shadows) return true;
  ++rays;
  return !IsBlocked(scene_.surfaces, {vertex.hit.x_in_world, direction}, distance);
}

// The direct light of all lights, and one sample of the environment, weighted for multiple
// importance sampling.
Color PathTracer::DirectLight(const Vertex& vertex, UniformStream& random,
                              std::int64_t& rays) const {
  const Brdf& brdf = *BrdfAt(*vertex.hit.item, vertex.hit.x_in_world);
  Color sum = Color::Zero();
  const auto add = [&](const Vector3d& to_light, double distance, const Color& light) {
    const Vector3d w_i = vertex.ToSurface(to_light);
    if (w_i.z() <= 0) return;
    const Color f = brdf.Eval(vertex.w_o, w_i);
    if (f.isZero(0) || !IsUnoccluded(vertex, to_light, distance, rays)) return;
    sum += f * light * w_i.z();
  };
  for (const auto& light : scene_.directional_lights) add(light.to_light, kFar, light.irradiance);
  for (const auto& light : scene_.point_lights) {
    const IncidentLight incident = IncidentFrom(light, vertex.hit.x_in_world);
    add(incident.to_light, incident.distance, incident.irradiance);
  }
  if (scene_.environment) {
    if (const auto drawn = scene_.environment->Sample(random.Next2())) {
      const double other = brdf.Pdf(vertex.w_o, vertex.ToSurface(drawn->direction));
      add(drawn->direction, kFar,
          drawn->radiance * (PowerHeuristic(drawn->pdf, other) / drawn->pdf));
    }
  }
  return sum;
}

Color PathTracer::Radiance(Ray ray, UniformStream& random, std::int64_t& rays) const {
  Color radiance = Color::Zero();
  Color throughput = Color::Ones();
  double brdf_pdf = 0;  // density of the ray, from the last BRDF
  const EnvironmentMap* environment = scene_.environment.get();
  const auto environment_by_brdf = [&](const Vector3d& direction, double pdf) -> Color {
    return environment->Radiance(direction) * PowerHeuristic(pdf, environment->Pdf(direction));
  };
  for (int depth = 0;; ++depth) {
    const bool seen = depth == 0 ? terms_.emission : terms_.direct;
    ++rays;
    const auto hit = FirstHit(scene_.surfaces, ray);
    if (!hit) {
      if (environment && depth == 0 && seen)
        radiance += environment->Radiance(ray.direction_in_world);
      if (environment && depth > 0 && terms_.shadows) {
        radiance += throughput * environment_by_brdf(ray.direction_in_world, brdf_pdf);
      }
      return radiance;
    }
    if (seen) radiance += throughput * hit->item->emission;
    if (!terms_.direct || depth > terms_.bounces) return radiance;

    const Vertex vertex(*hit, -ray.direction_in_world);
    if (const auto lit = exitance_.find(hit->item); lit != exitance_.end()) {
      radiance += throughput * lit->second.Radiance(hit->x_in_world, vertex.w_o.z());
    }
    const Brdf* const brdf = BrdfAt(*hit->item, hit->x_in_world);
    if (brdf == nullptr) return radiance;
    radiance += throughput * DirectLight(vertex, random, rays);

    // The next ray samples the environment, emitters and indirect light by the BRDF.
    const bool needs_ray =
        depth < terms_.bounces || has_emitters_ || (environment && terms_.shadows);
    if (!needs_ray && !environment) return radiance;
    const auto sample = brdf->Sample(vertex.w_o, random.Next3());
    if (!sample) return radiance;
    throughput *= sample->f * (sample->w_i.z() / sample->pdf);
    brdf_pdf = sample->pdf;
    ray = {hit->x_in_world, vertex.world_from_surface * sample->w_i};
    if (environment && !terms_.shadows) {
      radiance += throughput * environment_by_brdf(ray.direction_in_world, brdf_pdf);
    }
    if (!needs_ray || throughput.isZero(0)) return radiance;
  }
}

}  // namespace nerf
