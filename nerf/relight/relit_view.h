#pragma once

#include <cstdint>
#include <optional>
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
  torch::Tensor surface_normal;      // [P,3] unit, of the mesh
  torch::Tensor to_camera;           // [P,3] unit
  torch::Tensor vertex;              // [P] int64, the nearest of the mesh: of its shadows
  MaterialBatch material;            // [P]
};

// What it reflects, linear, [P,3].
struct RelitPixels {
  torch::Tensor direct;      // of the environment and of lamps
  torch::Tensor indirect;    // of light that other parts of the surface reflect
  torch::Tensor specular;    // what of both the facets reflect
  torch::Tensor visibility;  // [P] share of the environment that is not in shadow, by cosine
};

// Shows a surface under lights. The shadows of the environment are traced once.
class Relighter {
 public:
  // `surface` must outlive it. Uses all threads, for some seconds.
  explicit Relighter(const RelightableSurface& surface);

  // Another light, which is known. Computes what every vertex reflects, for light that is reflected
  // so many times before it arrives at a pixel: 0 is direct light only. The surface may have been
  // edited since.
  void SetLight(const LightGroup& light, int bounces);

  // What is opaque in a picture of the surface (by the field, which draws its silhouette exactly):
  // the mesh gives positions and normals.
  SeenSurface See(const DepthMap& picture) const;
  RelitPixels Reflect(const SeenSurface& seen) const;

 private:
  struct SurfacePoint {
    Eigen::Vector3f position, normal;
    std::int64_t vertex;
  };
  std::optional<SurfacePoint> PointAlong(const Eigen::Vector3f& origin,
                                         const Eigen::Vector3f& ray, float farthest) const;
  // What a pixel shows of the surface, or one close by; nullopt: nothing.
  std::optional<SurfacePoint> PointAt(const DepthMap& picture, std::int64_t pixel) const;

  // What lamps and environment send to points, reflected towards the camera.
  ReflectedLight Direct(const SurfaceBatch& surface, const MaterialBatch& material,
                        const torch::Tensor& position, const torch::Tensor& vertex) const;

  const RelightableSurface& surface_;
  MeshRays rays_;
  float offset_;  // at which shadow rays begin
  LightTransport transport_;
  torch::Tensor position_, normal_;  // [V,3] of the vertices
  MaterialBatch material_;           // of the vertices
  torch::Tensor environment_;        // [D,3]
  bool is_dark_ = false;             // the environment is black
  LampTable lamps_;
  torch::Tensor radiance_;  // [V,3] of the vertices; undefined: without bounces
};

}  // namespace nerf
