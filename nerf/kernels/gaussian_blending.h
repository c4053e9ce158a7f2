#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "nerf/kernels/gaussians.h"

namespace nerf::kernels {

// The picture is blended in tiles of 8 x 16 pixels: a vector of 16 lanes has two rows of one, a
// vector of 8 one row, so that a small Gaussian fills most of the lanes that it needs.
inline constexpr int kTileWidth = 8, kTileHeight = 16;
inline constexpr int kTilePixels = kTileWidth * kTileHeight;

// A Gaussian of a tile.
struct TileEntry {
  std::uint32_t gaussian = 0;  // index of its projection
  std::uint32_t slot = 0;      // where its gradients of this tile belong
};

// [pixel] of a tile, row after row.
struct alignas(64) TilePicture {
  std::array<std::array<float, kTilePixels>, 3> rgb;  // without background
  std::array<float, kTilePixels> transmittance;       // left for the background
  std::array<float, kTilePixels> distance;            // sum of weight times distance
};

// A tile of the picture: its corner in pixels, and its Gaussians, front to back.
struct Tile {
  int x = 0, y = 0;
  std::span<const TileEntry> entries;
};

// Blends front to back: C = sum T_i alpha_i c_i, T_{i+1} = T_i (1 - alpha_i). The transmittance
// stays positive, since alpha is below kMostOpacity. A Gaussian is left out where all pixels of a
// vector have a transmittance below kStopTransmittance: that changes a pixel by at most this.
//   returns  how many entries were needed: the others are behind what is opaque
std::int64_t BlendTile(std::span<const ProjectedGaussian> gaussians, const Tile& tile,
                       TilePicture& picture);

// The backward pass, in the same order, so that nothing is divided by a transmittance: what is
// behind a Gaussian is the whole minus what is in front.
//   tile      only the entries that were needed
//   picture   of BlendTile
//   dL_dpicture  gradients by the same
//   moments   written at the slots of the entries
void BlendTileBackward(std::span<const ProjectedGaussian> gaussians, const Tile& tile,
                       const TilePicture& picture, const TilePicture& dL_dpicture,
                       std::span<GaussianMoments> moments);

}  // namespace nerf::kernels
