#include "nerf/relight/surface_observations.h"

#include <algorithm>

#include "nerf/base/parallel.h"
#include "nerf/image/srgb.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr float kOpaque = 0.999f;
constexpr float kClipped = 0.995f;        // of sRGB
constexpr float kLeastSeenCosine = 0.1f;  // between normal and ray

struct Observation {
  Eigen::Vector3f position, normal, to_camera, radiance;
  std::int64_t vertex;
};

// The light of a stored pixel; nullopt: it says nothing about the surface.
std::optional<Eigen::Vector3f> RadianceOf(const View& view, std::int64_t k,
                                          ColorEncoding encoding) {
  Eigen::Vector4f rgba;
  for (int c = 0; c < 4; ++c) rgba[c] = static_cast<float>(view.rgba[4 * k + c]);
  if (rgba[kAlphaChannel] < kOpaque) return std::nullopt;
  if (encoding == ColorEncoding::kLinear) return rgba.head<3>();
  if (rgba.head<3>().maxCoeff() >= kClipped) return std::nullopt;
  return Eigen::Vector3f(rgba.head<3>().unaryExpr(&LinearFromSrgb));
}

std::vector<Observation> ObserveFrom(const ObservedView& view, ColorEncoding encoding,
                                     const Mesh& surface, const MeshRays& rays) {
  std::vector<Observation> observations;
  const View& photograph = *view.photograph;
  const Eigen::Vector3f origin = view.surface_from_camera.translation().cast<float>();
  for (std::int64_t k = 0; k < photograph.StoredCount(); ++k) {
    const auto radiance = RadianceOf(photograph, k, encoding);
    if (!radiance) continue;
    const std::int64_t pixel = photograph.PixelIndex(k);
    const auto direction =
        DirectionFromPixel(view.camera, {static_cast<double>(pixel % view.camera.width) + 0.5,
                                         static_cast<double>(pixel / view.camera.width) + 0.5});
    if (!direction) continue;
    const Eigen::Vector3f ray = (view.surface_from_camera.linear() * *direction).cast<float>();
    const auto hit = rays.FirstHit(origin, ray);
    if (!hit || !hit->is_front) continue;
    const Eigen::Vector3f normal = NormalAt(surface, *hit);
    if (normal.isZero() || -normal.dot(ray) < kLeastSeenCosine) continue;
    observations.push_back(
        {origin + hit->distance * ray, normal, -ray, *radiance, NearestVertex(surface, *hit)});
  }
  return observations;
}

}  // namespace

SurfaceObservations ObserveSurface(const std::vector<ObservedView>& views, ColorEncoding encoding,
                                   const Mesh& surface, const MeshRays& rays) {
  std::vector<std::vector<Observation>> of_views(views.size());
  ParallelForEach(static_cast<std::int64_t>(views.size()), [&](std::int64_t i) {
    of_views[i] = ObserveFrom(views[i], encoding, surface, rays);
  });
  std::int64_t count = 0;
  for (const auto& own : of_views) count += static_cast<std::int64_t>(own.size());
  SurfaceObservations all;
  for (torch::Tensor* rows : {&all.position, &all.normal, &all.to_camera, &all.radiance}) {
    *rows = torch::empty({count, 3});
  }
  all.vertex = torch::empty({count}, torch::kLong);
  all.group = torch::empty({count}, torch::kLong);
  std::int64_t i = 0;
  for (std::size_t view = 0; view < views.size(); ++view) {
    auto& own = of_views[view];
    for (const Observation& o : own) {
      std::copy_n(o.position.data(), 3, all.position.data_ptr<float>() + 3 * i);
      std::copy_n(o.normal.data(), 3, all.normal.data_ptr<float>() + 3 * i);
      std::copy_n(o.to_camera.data(), 3, all.to_camera.data_ptr<float>() + 3 * i);
      std::copy_n(o.radiance.data(), 3, all.radiance.data_ptr<float>() + 3 * i);
      all.group.data_ptr<std::int64_t>()[i] = views[view].group;
      all.vertex.data_ptr<std::int64_t>()[i++] = o.vertex;
    }
    own = {};
  }
  return all;
}

torch::Tensor MeanRadiance(const SurfaceObservations& observations, std::int64_t groups,
                           std::int64_t vertices) {
  const torch::Tensor row = observations.vertex + vertices * observations.group;
  const torch::Tensor count = torch::zeros({groups * vertices, 1})
                                  .index_add_(0, row, torch::ones({observations.Size(), 1}));
  return (torch::zeros({groups * vertices, 3}).index_add_(0, row, observations.radiance) /
          count.clamp_min(1))
      .view({groups, vertices, 3});
}

}  // namespace nerf
