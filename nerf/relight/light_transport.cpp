#include "nerf/relight/light_transport.h"

#include <algorithm>
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

ArrivingLight LightAt(const LightTransport& transport, const torch::Tensor& vertices,
                      const torch::Tensor& environment, const torch::Tensor& radiance) {
  const torch::Tensor blocker = transport.blocker.index_select(0, vertices).to(torch::kLong);
  const torch::Tensor is_open = blocker == LightTransport::kOpen;
  ArrivingLight light;
  light.directions = transport.directions.to(environment.options());
  light.radiance = environment;
  light.visibility = is_open.to(environment.scalar_type());
  const torch::Tensor from = radiance.index_select(0, blocker.clamp_min(0).flatten())
                                 .view({vertices.size(0), light.directions.size(0), 3});
  light.indirect = from * (1 - light.visibility).unsqueeze(2);
  return light;
}

}  // namespace nerf
