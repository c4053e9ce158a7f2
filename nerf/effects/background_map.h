#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nerf/image/image.h"

namespace nerf {

// Radiance by direction: an equirectangular map of longitude (about z, columns) and polar angle
// from +z (rows), interpolated bilinearly between texel centres, then passed through the activation
// of the field's colours: a sigmoid for sRGB-encoded colours, exp for linear ones. Plain loops, for
// FusedEngine and the renderers; Background is the same as autograd operations.
struct BackgroundMap {
  int rows = 0;  // with 2 * rows columns
  ColorEncoding encoding = ColorEncoding::kSrgb;
  std::vector<float> raw;  // [rows, 2 * rows, 3] before the activation

  struct Texels {
    std::array<std::int64_t, 4> index{};
    std::array<float, 4> weight{};  // sum to 1
  };
  // The four texels that are interpolated for a direction.
  //   direction  unit vector
  static Texels TexelsOf(std::span<const float, 3> direction, int rows);

  //   direction  [R,3] unit vectors
  //   rgb        [R,3] result, in the encoding of the map
  void Radiance(std::span<const float> direction, std::span<float> rgb) const;

  // The backward pass of one ray: accumulates into dL_draw, which has the layout of raw.
  //   rgb  what Radiance returned for the direction
  void AddGradient(std::span<const float, 3> direction, std::span<const float, 3> rgb,
                   std::span<const float, 3> dL_drgb, std::span<float> dL_draw) const;
};

}  // namespace nerf
