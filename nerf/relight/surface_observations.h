#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/geometry/mesh.h"
#include "nerf/geometry/mesh_rays.h"
#include "nerf/image/image.h"
#include "nerf/scene/view.h"

namespace nerf {

// A photograph with its pose in the frame of the surface.
struct ObservedView {
  const View* photograph = nullptr;  // must outlive this
  Camera camera;
  Eigen::Isometry3d surface_from_camera;
  std::int64_t group = 0;  // of photographs under one light
};

// Pixels of photographs that show a surface; N in the order of views and pixels.
struct SurfaceObservations {
  torch::Tensor position;   // [N,3] where the ray of the pixel's centre meets the surface
  torch::Tensor normal;     // [N,3] unit, interpolated between the vertices
  torch::Tensor to_camera;  // [N,3] unit
  torch::Tensor radiance;   // [N,3] linear
  torch::Tensor vertex;     // [N] int64, the nearest one of the face
  torch::Tensor group;      // [N] int64, of the photograph

  std::int64_t Size() const { return vertex.size(0); }
};

// Left out are pixels that are not opaque (they mix the surface with what is behind it), clipped
// ones, those whose ray meets the back of the surface or an invalid normal, and surfaces seen at
// more than 84 degrees.
//   encoding  of the photographs
SurfaceObservations ObserveSurface(const std::vector<ObservedView>& views, ColorEncoding encoding,
                                   const Mesh& surface, const MeshRays& rays);

// [G,V,3] the mean of what the photographs of each group show at each vertex; 0 where none does.
torch::Tensor MeanRadiance(const SurfaceObservations& observations, std::int64_t groups,
                           std::int64_t vertices);

}  // namespace nerf
