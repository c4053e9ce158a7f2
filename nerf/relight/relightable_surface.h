#pragma once

#include <memory>

#include "nerf/geometry/mesh.h"
#include "nerf/geometry/scalar_grid.h"
#include "nerf/relight/material_field.h"

namespace nerf {

// A surface with its materials, and the light under which it was photographed: all that is needed
// to show it under another light. In the normalized frame.
struct RelightableSurface {
  ScalarGrid distance;  // signed, its gradient points outwards
  Mesh mesh;            // where it is 0, with normals
  std::shared_ptr<MaterialField> field;
  double normal_offset = 0;  // of ShadingNormals
  torch::Tensor light;  // [D,3] from the directions of LightDirections(D), as photographs show it
};

// The normals that are shaded: those of the surface, turned by the offsets of the material field.
torch::Tensor ShadingNormals(const torch::Tensor& normal, const torch::Tensor& offset,
                             double most_offset);

}  // namespace nerf
