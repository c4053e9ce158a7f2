#pragma once

#include <cstdint>
#include <vector>

#include "nerf/geometry/mesh_rays.h"
#include "nerf/relight/light_transport.h"
#include "nerf/relight/relightable_surface.h"
#include "nerf/scene/depth_fusion.h"

namespace nerf {

// What a camera sees of a surface.
struct SeenSurface {
  std::vector<std::int64_t> pixels;  // [P] y * width + x, ascending
  torch::Tensor position;            // [P,3]
  torch::Tensor normal;              // [P,3] unit, that are shaded
  torch::Tensor surface_normal;      // [P,3] unit, of the signed distance
  torch::Tensor to_camera;           // [P,3] unit
  torch::Tensor vertex;              // [P] int64, the nearest of the mesh: for its shadows
  MaterialBatch material;            // [P]
};

// What it reflects, linear, [P,3].
struct RelitPixels {
  torch::Tensor direct;      // of the environment
  torch::Tensor indirect;    // of light that other parts of the surface reflect
  torch::Tensor specular;    // what of both the facets reflect
  torch::Tensor visibility;  // [P] share of the environment that is not in shadow, by cosine
};

// Shows a surface under lights. The shadows are traced once.
class Relighter {
 public:
  // `surface` must outlive it. Uses all threads, for some seconds.
  explicit Relighter(const RelightableSurface& surface);

  const torch::Tensor& Directions() const { return transport_.directions; }

  // The light from Directions() [D,3]. Computes what every vertex reflects, for light that is
  // reflected so many times before it arrives at a pixel: 0 is direct light only.
  void SetLight(const torch::Tensor& light, int bounces);

  // What is opaque in a picture of the surface (by the field, which draws its silhouette exactly):
  // its distance gives the position, the signed distance the normal.
  SeenSurface See(const DepthMap& picture) const;
  RelitPixels Reflect(const SeenSurface& seen) const;

 private:
  const RelightableSurface& surface_;
  MeshRays rays_;
  LightTransport transport_;
  SurfaceBatch vertices_;
  MaterialBatch material_;  // of the vertices
  torch::Tensor light_;     // [D,3]
  torch::Tensor radiance_;  // [V,3] of the vertices
};

}  // namespace nerf
