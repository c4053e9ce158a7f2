#pragma once

#include "nerf/geometry/level_set_mesh.h"
#include "nerf/geometry/normal_filter.h"

namespace nerf {

// The surface where a signed distance is 0, with normals smoothed between edges: depth is noisier
// than surfaces are rough.
inline Mesh SurfaceMesh(const ScalarGrid& distance) {
  Mesh mesh = LevelSetMesh(distance, 0);
  FilterNormals(mesh, {});
  return mesh;
}

}  // namespace nerf
