#include "nerf/relight/relit_view.h"

#include <algorithm>

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr float kLeastOpacity = 0.02f;
constexpr double kOffset = 1.5;  // cells, at which shadow rays begin
constexpr double kReach = 3;     // cells, from a pixel's position to the mesh
constexpr std::int64_t kChunk = 1024;

int DirectionsOf(const RelightableSurface& surface) {
  return static_cast<int>(surface.light.size(0));
}

torch::Tensor RowsOf(const std::vector<Eigen::Vector3f>& vectors) {
  torch::Tensor rows = torch::empty({static_cast<std::int64_t>(vectors.size()), 3});
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    std::copy_n(vectors[i].data(), 3, rows.data_ptr<float>() + 3 * i);
  }
  return rows;
}

MaterialBatch Part(const MaterialBatch& all, std::int64_t begin, std::int64_t end) {
  return {all.base_color.slice(0, begin, end), all.roughness.slice(0, begin, end),
          all.metallic.slice(0, begin, end)};
}

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
      transport_(TraceLight(surface.mesh, rays_, DirectionsOf(surface),
                            static_cast<float>(kOffset * surface.distance.cell))) {
  const torch::NoGradGuard no_grad;
  vertices_.normal = vertices_.to_camera = RowsOf(surface.mesh.normals);
  material_ = surface.field->forward(RowsOf(surface.mesh.vertices)).material;
  SetLight(surface.light, 0);
}

void Relighter::SetLight(const torch::Tensor& light, int bounces) {
  TORCH_CHECK(light.sizes() == surface_.light.sizes(), "a light of ", light.sizes(), " for ",
              DirectionsOf(surface_), " directions");
  const torch::NoGradGuard no_grad;
  light_ = light;
  radiance_ = torch::zeros_like(vertices_.normal);
  for (int bounce = 0; bounce < bounces; ++bounce) {
    torch::Tensor next = torch::empty_like(radiance_);
    InChunks(radiance_.size(0), [&](std::int64_t begin, std::int64_t end) {
      const torch::Tensor normal = vertices_.normal.slice(0, begin, end);
      const ReflectedLight out =
          Shade({normal, normal}, Part(material_, begin, end),
                LightAt(transport_, torch::arange(begin, end, torch::kLong), light_, radiance_));
      next.slice(0, begin, end).copy_(out.diffuse + out.specular);
    });
    radiance_ = next;
  }
}

SeenSurface Relighter::See(const DepthMap& picture) const {
  const torch::NoGradGuard no_grad;
  const Eigen::Isometry3d& pose = picture.grid_from_camera;
  const auto reach = static_cast<float>(kReach * surface_.distance.cell);
  SeenSurface seen;
  std::vector<Eigen::Vector3f> position, normal, to_camera;
  std::vector<std::int64_t> vertex;
  for (std::int64_t pixel = 0; pixel < PixelCount(picture.camera); ++pixel) {
    if (picture.opacity.pixels[static_cast<std::size_t>(pixel)] < kLeastOpacity) continue;
    const auto direction = DirectionFromPixel(
        picture.camera, {static_cast<double>(pixel % picture.camera.width) + 0.5,
                         static_cast<double>(pixel / picture.camera.width) + 0.5});
    if (!direction) continue;
    const Eigen::Vector3f ray = (pose.linear() * *direction).cast<float>();
    const Eigen::Vector3f origin = pose.translation().cast<float>();
    const Eigen::Vector3f at =
        origin + picture.distance.pixels[static_cast<std::size_t>(pixel)] * ray;
    const Eigen::Vector3f outwards =
        surface_.distance.Gradient(at.cast<double>()).stableNormalized().cast<float>();
    if (outwards.isZero()) continue;  // no normal: not shaded
    // The mesh below the point, or where the ray meets it.
    auto hit = rays_.FirstHit(at + reach * outwards, -outwards);
    if (!hit || hit->distance > 2 * reach) hit = rays_.FirstHit(origin, ray);
    if (!hit) continue;
    seen.pixels.push_back(pixel);
    vertex.push_back(NearestVertex(surface_.mesh, *hit));
    position.push_back(at);
    normal.push_back(outwards);
    to_camera.push_back(-ray);
  }
  seen.position = RowsOf(position);
  seen.surface_normal = RowsOf(normal);
  seen.to_camera = RowsOf(to_camera);
  seen.vertex = torch::tensor(vertex, torch::kLong);
  SurfaceProperties found = surface_.field->forward(seen.position);
  seen.normal = ShadingNormals(seen.surface_normal, found.normal_offset, surface_.normal_offset);
  seen.material = std::move(found.material);
  return seen;
}

RelitPixels Relighter::Reflect(const SeenSurface& seen) const {
  const torch::NoGradGuard no_grad;
  RelitPixels relit;
  relit.direct = torch::empty_like(seen.normal);
  relit.indirect = torch::empty_like(seen.normal);
  relit.specular = torch::empty_like(seen.normal);
  relit.visibility = torch::empty({seen.normal.size(0)});
  InChunks(seen.normal.size(0), [&](std::int64_t begin, std::int64_t end) {
    const auto part = [&](const torch::Tensor& all) { return all.slice(0, begin, end); };
    const SurfaceBatch surface{part(seen.normal), part(seen.to_camera)};
    const MaterialBatch material = Part(seen.material, begin, end);
    ArrivingLight light = LightAt(transport_, part(seen.vertex), light_, radiance_);
    const ReflectedLight all = Shade(surface, material, light);
    const torch::Tensor cosine = torch::matmul(surface.normal, light.directions.t()).clamp_min(0);
    part(relit.visibility)
        .copy_((cosine * light.visibility).sum(1) / cosine.sum(1).clamp_min(1e-6));
    light.indirect = torch::Tensor();
    const ReflectedLight direct = Shade(surface, material, light);
    part(relit.direct).copy_(direct.diffuse + direct.specular);
    part(relit.indirect).copy_(all.diffuse + all.specular - direct.diffuse - direct.specular);
    part(relit.specular).copy_(all.specular);
  });
  return relit;
}

}  // namespace nerf
