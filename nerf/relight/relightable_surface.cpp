#include "nerf/relight/relightable_surface.h"

namespace nerf {

SurfaceProperties RelightableSurface::At(const torch::Tensor& positions) const {
  SurfaceProperties found = field->forward(positions);
  for (const MaterialEdit& edit : edits) Apply(edit, positions, found.material);
  return found;
}

torch::Tensor ShadingNormals(const torch::Tensor& normal, const torch::Tensor& offset,
                             double most_offset) {
  const torch::Tensor turned = normal + most_offset * offset;
  return turned / turned.norm(2, 1, true).clamp_min(1e-6);
}

}  // namespace nerf
