#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/geometry/mesh_rays.h"
#include "nerf/light/lights.h"

namespace nerf {

// A light of no extent: a sun, or a lamp. In the frame of the surface.
using Lamp = std::variant<DirectionalLight, PointLight>;

// What one lamp sends to each of P points.
struct LampLight {
  torch::Tensor to_light;    // [P,3] unit
  torch::Tensor irradiance;  // [P,3] on a surface that faces it
};

// The lamps of several groups of photographs. Each point has those of its group; a group with fewer
// than the most has dark ones.
class LampTable {
 public:
  explicit LampTable(const std::vector<std::vector<Lamp>>& of_groups);

  // Lamps of a group.
  std::int64_t Most() const { return most_; }

  // Lamp `index` of the groups of points, without shadows.
  //   positions  [P,3]
  //   group      [P] int64
  LampLight At(const torch::Tensor& positions, const torch::Tensor& group,
               std::int64_t index) const;

  // [P, Most()] 1 where the light of a lamp arrives, 0 in its shadow. Rays begin at a distance
  // `offset` before a point, along its normal. Uses all threads.
  torch::Tensor Visibility(const torch::Tensor& positions, const torch::Tensor& normals,
                           const torch::Tensor& group, const MeshRays& rays, float offset) const;

 private:
  std::int64_t most_ = 0;
  torch::Tensor place_;   // [G, most, 3] a position, or a direction to the light
  torch::Tensor is_sun_;  // [G, most] 1 or 0
  torch::Tensor power_;   // [G, most, 3] irradiance of a sun, intensity of a lamp
};

}  // namespace nerf
