#include "nerf/relight/relit_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "nerf/relight/rows.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr float kLeastOpacity = 0.02f;
constexpr double kOffset = 1.5;  // cells, at which shadow rays begin
constexpr float kReach = 3;      // cells, from what the field shows to the mesh
constexpr int kAround = 8;       // rays about a pixel that misses the mesh
constexpr std::int64_t kChunk = 1024;

// Calls body(begin, end) for parts of so many points as fit in the cache with their directions.
template <class Body>
void InChunks(std::int64_t points, const Body& body) {
  for (std::int64_t begin = 0; begin < points; begin += kChunk) {
    body(begin, std::min(points, begin + kChunk));
  }
}

}  // namespace

Relighter::Relighter(const RelightableSurface& surface)
    : surface_(surface),
      rays_(surface.mesh),
      offset_(static_cast<float>(kOffset * surface.distance.cell)),
      position_(RowsOf(surface.mesh.vertices)),
      normal_(RowsOf(surface.mesh.normals)),
      lamps_({}) {
  if (surface.has_shadows) {
    transport_ = TraceLight(surface.mesh, rays_, surface.Directions(), offset_);
  } else {
    transport_.directions = LightDirections(surface.Directions());
  }
  SetLight(surface.lights.front(), 0);
}

ReflectedLight Relighter::Direct(const SurfaceBatch& surface, const MaterialBatch& material,
                                 const torch::Tensor& position, const torch::Tensor& vertex) const {
  ReflectedLight sum{torch::zeros_like(surface.normal), torch::zeros_like(surface.normal)};
  if (!is_dark_) sum = Shade(surface, material, LightAt(transport_, vertex, environment_, {}));
  if (lamps_.Most() == 0) return sum;
  const torch::Tensor group = torch::zeros({position.size(0)}, torch::kLong);
  const torch::Tensor visible =
      surface_.has_shadows ? lamps_.Visibility(position, surface.normal, group, rays_, offset_)
                           : torch::ones({position.size(0), lamps_.Most()});
  for (std::int64_t k = 0; k < lamps_.Most(); ++k) {
    const LampLight lamp = lamps_.At(position, group, k);
    const ReflectedLight of_lamp =
        ShadeFrom(surface, material, lamp.to_light, lamp.irradiance * visible.slice(1, k, k + 1));
    sum = {sum.diffuse + of_lamp.diffuse, sum.specular + of_lamp.specular};
  }
  return sum;
}

void Relighter::SetLight(const LightGroup& light, int bounces) {
  TORCH_CHECK(light.environment.sizes() == torch::IntArrayRef({surface_.Directions(), 3}),
              "a light of ", light.environment.sizes(), " for ", surface_.Directions(),
              " directions");
  const torch::NoGradGuard no_grad;
  material_ = surface_.At(position_).material;
  environment_ = light.environment;
  is_dark_ = environment_.abs().max().item<float>() == 0;
  lamps_ = LampTable({light.lamps});
  radiance_ = torch::Tensor();
  if (bounces == 0 || !surface_.has_shadows || !surface_.has_bounces) return;
  torch::Tensor direct = torch::empty_like(normal_);
  InChunks(normal_.size(0), [&](std::int64_t begin, std::int64_t end) {
    const torch::Tensor normal = normal_.slice(0, begin, end);
    direct.slice(0, begin, end)
        .copy_(Direct({normal, normal}, material_.Rows(begin, end), position_.slice(0, begin, end),
                      torch::arange(begin, end, torch::kLong))
                   .Sum());
  });
  radiance_ = direct;
  const torch::Tensor dark = torch::zeros_like(environment_);
  for (int bounce = 1; bounce < bounces; ++bounce) {
    torch::Tensor next = direct.clone();
    InChunks(normal_.size(0), [&](std::int64_t begin, std::int64_t end) {
      const torch::Tensor normal = normal_.slice(0, begin, end);
      const ArrivingLight nearby =
          LightAt(transport_, torch::arange(begin, end, torch::kLong), dark, radiance_);
      next.slice(0, begin, end)
          .add_(Shade({normal, normal}, material_.Rows(begin, end), nearby).Sum());
    });
    radiance_ = next;
  }
}

std::optional<Relighter::SurfacePoint> Relighter::PointAlong(const Eigen::Vector3f& origin,
                                                             const Eigen::Vector3f& ray,
                                                             float farthest) const {
  const auto hit = rays_.FirstHit(origin, ray);
  if (!hit || hit->distance > farthest) return std::nullopt;
  const Eigen::Vector3f normal = NormalAt(surface_.mesh, *hit);
  if (normal.isZero()) return std::nullopt;  // no normal: not shaded
  return SurfacePoint{origin + hit->distance * ray, normal, NearestVertex(surface_.mesh, *hit)};
}

std::optional<Relighter::SurfacePoint> Relighter::PointAt(const DepthMap& picture,
                                                          std::int64_t pixel) const {
  constexpr float kAnywhere = std::numeric_limits<float>::infinity();
  const auto cell = static_cast<float>(surface_.distance.cell);
  const Eigen::Vector3f origin = picture.grid_from_camera.translation().cast<float>();
  const auto x = static_cast<double>(pixel % picture.camera.width) + 0.5;
  const auto y = static_cast<double>(pixel / picture.camera.width) + 0.5;
  const auto ray_through = [&](double at_x, double at_y) -> std::optional<Eigen::Vector3f> {
    const auto direction = DirectionFromPixel(picture.camera, {at_x, at_y});
    if (!direction) return std::nullopt;
    return Eigen::Vector3f((picture.grid_from_camera.linear() * *direction).cast<float>());
  };
  const auto ray = ray_through(x, y);
  if (!ray) return std::nullopt;
  // The mesh below the point that the field shows.
  const Eigen::Vector3f at =
      origin + picture.distance.pixels[static_cast<std::size_t>(pixel)] * *ray;
  const Eigen::Vector3f outwards =
      surface_.distance.Gradient(at.cast<double>()).stableNormalized().cast<float>();
  std::optional<SurfacePoint> below;
  if (!outwards.isZero()) {
    below = PointAlong(at + kReach * cell * outwards, -outwards, 2 * kReach * cell);
  }
  if (below) return below;
  if (const auto met = PointAlong(origin, *ray, kAnywhere)) return met;
  for (const double distance : {0.7, 1.5}) {
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      const auto beside =
          ray_through(x + distance * std::cos(angle), y + distance * std::sin(angle));
      if (!beside) continue;
      if (const auto point = PointAlong(origin, *beside, kAnywhere)) return point;
    }
  }
  return std::nullopt;
}

SeenSurface Relighter::See(const DepthMap& picture) const {
  const torch::NoGradGuard no_grad;
  SeenSurface seen;
  std::vector<Eigen::Vector3f> position, normal, to_camera;
  std::vector<std::int64_t> vertex;
  const Eigen::Vector3f centre = picture.grid_from_camera.translation().cast<float>();
  for (std::int64_t pixel = 0; pixel < PixelCount(picture.camera); ++pixel) {
    if (picture.opacity.pixels[static_cast<std::size_t>(pixel)] < kLeastOpacity) continue;
    const auto point = PointAt(picture, pixel);
    if (!point) continue;
    seen.pixels.push_back(pixel);
    vertex.push_back(point->vertex);
    position.push_back(point->position);
    normal.push_back(point->normal);
    to_camera.push_back((centre - point->position).normalized());
  }
  seen.position = RowsOf(position);
  seen.surface_normal = RowsOf(normal);
  seen.to_camera = RowsOf(to_camera);
  seen.vertex = torch::tensor(vertex, torch::kLong);
  SurfaceProperties found = surface_.At(seen.position);
  seen.normal = ShadingNormals(seen.surface_normal, found.normal_offset, surface_.normal_offset);
  seen.material = std::move(found.material);
  return seen;
}

RelitPixels Relighter::Reflect(const SeenSurface& seen) const {
  const torch::NoGradGuard no_grad;
  RelitPixels relit;
  relit.direct = torch::empty_like(seen.normal);
  relit.indirect = torch::zeros_like(seen.normal);
  relit.specular = torch::empty_like(seen.normal);
  relit.visibility = torch::ones({seen.normal.size(0)});
  const torch::Tensor dark = torch::zeros_like(environment_);
  InChunks(seen.normal.size(0), [&](std::int64_t begin, std::int64_t end) {
    const auto part = [&](const torch::Tensor& all) { return all.slice(0, begin, end); };
    const SurfaceBatch surface{part(seen.normal), part(seen.to_camera)};
    const MaterialBatch material = seen.material.Rows(begin, end);
    const torch::Tensor vertex = part(seen.vertex);
    const ReflectedLight direct = Direct(surface, material, part(seen.position), vertex);
    part(relit.direct).copy_(direct.Sum());
    part(relit.specular).copy_(direct.specular);
    if (!surface_.has_shadows) return;
    const ArrivingLight nearby = LightAt(transport_, vertex, dark, radiance_);
    const torch::Tensor cosine = torch::matmul(surface.normal, nearby.directions.t()).clamp_min(0);
    part(relit.visibility)
        .copy_((cosine * nearby.visibility).sum(1) / cosine.sum(1).clamp_min(1e-6));
    if (!radiance_.defined()) return;
    const ReflectedLight indirect = Shade(surface, material, nearby);
    part(relit.indirect).copy_(indirect.Sum());
    part(relit.specular).add_(indirect.specular);
  });
  return relit;
}

}  // namespace nerf
