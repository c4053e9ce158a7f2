#pragma once

#include <array>
#include <span>

#include "nerf/kernels/gaussian_blending.h"

namespace nerf::kernels {

// Where the surfaces of a tile are: [pixel], row after row.
struct alignas(64) TileSurface {
  // Distance of the Gaussian behind which less than half of the light is left, normalized units;
  // 0 where more is left behind all of them.
  std::array<float, kTilePixels> median_distance;
  std::array<std::array<float, kTilePixels>, 3> normal;  // sum of weight times normal
};

// Blends like BlendTile, but normals, and finds the median distance. No gradients.
//   normals  of the projected Gaussians, unit vectors
void FindTileSurface(std::span<const ProjectedGaussian> gaussians,
                     std::span<const std::array<float, 3>> normals, const Tile& tile,
                     TileSurface& surface);

}  // namespace nerf::kernels
