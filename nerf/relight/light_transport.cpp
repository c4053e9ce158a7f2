#include "nerf/relight/light_transport.h"

#include <algorithm>
#include <array>
#include <vector>

#include "nerf/base/parallel.h"
#include "nerf/geometry/directions.h"

namespace nerf {
namespace {

// Sine of the angle below the horizon down to which rays are traced: the normals that are shaded
// may be turned that far from those of the vertices.
constexpr float kBelowHorizon = 0.3f;

}  // namespace

torch::Tensor LightDirections(int directions) {
  torch::Tensor rows = torch::empty({directions, 3});
  for (int d = 0; d < directions; ++d) {
    const Eigen::Vector3f direction = FibonacciDirection(d, directions).cast<float>();
    std::copy_n(direction.data(), 3, rows.data_ptr<float>() + 3 * d);
  }
  return rows;
}

LightTransport TraceLight(const Mesh& surface, const MeshRays& rays, int directions, float offset) {
  const auto vertices = static_cast<std::int64_t>(surface.vertices.size());
  LightTransport transport;
  transport.directions = LightDirections(directions);
  std::vector<Eigen::Vector3f> towards;
  for (int d = 0; d < directions; ++d) {
    towards.emplace_back(transport.directions.data_ptr<float>() + 3 * d);
  }
  transport.blocker = torch::full({vertices, directions}, LightTransport::kOpen, torch::kInt);
  std::int32_t* const blocker = transport.blocker.data_ptr<std::int32_t>();
  ParallelForEach(vertices, [&](std::int64_t v) {
    const Eigen::Vector3f& normal = surface.normals[static_cast<std::size_t>(v)];
    if (normal.isZero()) return;
    const Eigen::Vector3f origin = surface.vertices[static_cast<std::size_t>(v)] + offset * normal;
    for (int d = 0; d < directions; ++d) {
      if (normal.dot(towards[static_cast<std::size_t>(d)]) < -kBelowHorizon) continue;
      if (const auto hit = rays.FirstHit(origin, towards[static_cast<std::size_t>(d)])) {
        blocker[v * directions + d] = NearestVertex(surface, *hit);
      }
    }
  });
  return transport;
}

double BlockedShare(const Mesh& surface, const MeshRays& rays, float offset) {
  constexpr std::int64_t kVertices = 800;
  constexpr int kDirections = 256;
  const auto vertices = static_cast<std::int64_t>(surface.vertices.size());
  const std::int64_t count = std::min(vertices, kVertices);
  std::vector<std::array<double, 2>> of_vertices(static_cast<std::size_t>(count));
  ParallelForEach(count, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i * vertices / count);
    const Eigen::Vector3f& normal = surface.normals[v];
    auto& [blocked, all] = of_vertices[static_cast<std::size_t>(i)];
    for (int d = 0; d < kDirections; ++d) {
      const Eigen::Vector3f towards = FibonacciDirection(d, kDirections).cast<float>();
      const auto cosine = static_cast<double>(normal.dot(towards));
      if (cosine <= 0) continue;
      all += cosine;
      if (rays.IsBlocked(surface.vertices[v] + offset * normal, towards)) blocked += cosine;
    }
  });
  double blocked = 0, all = 0;
  for (const auto& own : of_vertices) {
    blocked += own[0];
    all += own[1];
  }
  return all > 0 ? blocked / all : 0;
}

ArrivingLight LightAt(const LightTransport& transport, const torch::Tensor& vertices,
                      const torch::Tensor& environment, const torch::Tensor& radiance) {
  ArrivingLight light;
  light.directions = transport.directions.to(environment.options());
  light.radiance = environment;
  if (!transport.blocker.defined()) return light;
  const torch::Tensor blocker = transport.blocker.index_select(0, vertices).to(torch::kLong);
  light.visibility = (blocker == LightTransport::kOpen).to(environment.scalar_type());
  if (!radiance.defined()) return light;
  const torch::Tensor from = radiance.index_select(0, blocker.clamp_min(0).flatten())
                                 .view({vertices.size(0), light.directions.size(0), 3});
  light.nearby = from * (1 - light.visibility).unsqueeze(2);
  return light;
}

ArrivingLight LightAt(const LightTransport& transport, const torch::Tensor& vertices,
                      const torch::Tensor& group, const torch::Tensor& environment,
                      const torch::Tensor& radiance) {
  if (environment.size(0) == 1) {
    return LightAt(transport, vertices, environment[0],
                   radiance.defined() ? radiance[0] : torch::Tensor());
  }
  ArrivingLight light;
  light.directions = transport.directions.to(environment.options());
  light.nearby = environment.index_select(0, group);
  if (!transport.blocker.defined()) return light;
  const torch::Tensor blocker = transport.blocker.index_select(0, vertices).to(torch::kLong);
  const torch::Tensor is_open = (blocker == LightTransport::kOpen).unsqueeze(2);
  if (!radiance.defined()) {
    light.nearby = light.nearby * is_open;
    return light;
  }
  const std::int64_t count = radiance.size(1);
  const torch::Tensor rows = blocker.clamp_min(0) + count * group.unsqueeze(1);
  const torch::Tensor from =
      radiance.view({-1, 3}).index_select(0, rows.flatten()).view(light.nearby.sizes());
  light.nearby = torch::where(is_open, light.nearby, from);
  return light;
}

}  // namespace nerf
