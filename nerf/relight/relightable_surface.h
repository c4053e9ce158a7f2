#pragma once

#include <memory>
#include <vector>

#include "nerf/geometry/mesh.h"
#include "nerf/geometry/scalar_grid.h"
#include "nerf/relight/light_group.h"
#include "nerf/relight/material_edit.h"
#include "nerf/relight/material_field.h"

namespace nerf {

// A surface with its materials, and the lights under which it was photographed: all that is needed
// to show it under another light. In the normalized frame.
struct RelightableSurface {
  ScalarGrid distance;  // signed, its gradient points outwards
  Mesh mesh;            // where it is 0, with normals
  std::shared_ptr<MaterialField> field;
  double normal_offset = 0;         // of ShadingNormals
  bool has_shadows = true;          // whether light is blocked
  bool has_bounces = true;          // and reflected from surface to surface
  std::vector<LightGroup> lights;   // at least one; all environments are known
  std::vector<MaterialEdit> edits;  // applied in this order

  int Directions() const { return static_cast<int>(lights.front().environment.size(0)); }
  // What the field knows of points [P,3], edited.
  SurfaceProperties At(const torch::Tensor& positions) const;
};

// The normals that are shaded: those of the surface, turned by the offsets of the material field.
torch::Tensor ShadingNormals(const torch::Tensor& normal, const torch::Tensor& offset,
                             double most_offset);

}  // namespace nerf
