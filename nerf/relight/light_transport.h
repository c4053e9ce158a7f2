#pragma once

#include <cstdint>
#include <vector>

#include "nerf/geometry/mesh.h"
#include "nerf/geometry/mesh_rays.h"
#include "nerf/relight/surface_shading.h"

namespace nerf {

// What stands between the vertices of a surface and the light from fixed directions, traced once.
struct LightTransport {
  // Of a direction from which the environment reaches a vertex.
  static constexpr std::int32_t kOpen = -1;

  torch::Tensor directions;  // [D,3], LightDirections
  // [V,D] int32: the vertex at which a ray of vertex v in a direction ends, or kOpen. Undefined:
  // without shadows, all directions of all vertices are open.
  torch::Tensor blocker;
};

// [D,3] unit, spread evenly over the sphere.
torch::Tensor LightDirections(int directions);

// Rays begin at a distance `offset` before a vertex, along its normal, so that the surface does not
// shadow itself where it is slightly uneven. Directions well below the horizon of a vertex, and all
// directions of a vertex without normal, are open: nothing of them is reflected. Uses all threads.
LightTransport TraceLight(const Mesh& surface, const MeshRays& rays, int directions, float offset);

// The share of the directions above the horizon that are blocked, weighted by the cosine: the mean
// of some hundred vertices. 0 where none has a normal. Uses all threads.
double BlockedShare(const Mesh& surface, const MeshRays& rays, float offset);

// The light that arrives at vertices: of the environment where it is open, and else what the
// blocking vertices radiate, to all directions alike. Differentiable in both radiances.
//   vertices     [P] int64
//   environment  [D,3] radiance
//   radiance     [V,3] of the vertices; undefined: they are black
ArrivingLight LightAt(const LightTransport& transport, const torch::Tensor& vertices,
                      const torch::Tensor& environment, const torch::Tensor& radiance);

// The same under several lights, of which each point has one.
//   group        [P] int64, the light of each point
//   environment  [G,D,3] radiance of each light
//   radiance     [G,V,3] of the vertices under each; undefined: they are black
ArrivingLight LightAt(const LightTransport& transport, const torch::Tensor& vertices,
                      const torch::Tensor& group, const torch::Tensor& environment,
                      const torch::Tensor& radiance);

}  // namespace nerf
