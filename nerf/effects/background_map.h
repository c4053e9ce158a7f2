#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nerf/image/image.h"

namespace nerf {

// Colours by direction, as a map of longitude (about z, columns) and of the angle from the zenith
// (rows), interpolated between the middles of four texels; what is interpolated goes through the
// activation of the field's colours, a sigmoid for sRGB-encoded and exp for linear ones. In plain
// loops, for FusedEngine and the renderers; Background is the same as autograd operations.
struct BackgroundMap {
  int rows = 0;  // and 2 rows columns
  ColorEncoding encoding = ColorEncoding::kSrgb;
  std::vector<float> raw;  // [rows, 2 rows, 3] before the activation

  struct Texels {
    std::array<std::int64_t, 4> index{};
    std::array<float, 4> weight{};  // sum to 1
  };
  //   direction  unit vector
  static Texels TexelsOf(std::span<const float, 3> direction, int rows);

  // direction, rgb [R,3]
  void Radiance(std::span<const float> direction, std::span<float> rgb) const;

  // The way back of one ray: adds to dL_draw, which is laid out as raw.
  void AddGradient(std::span<const float, 3> direction, std::span<const float, 3> rgb,
                   std::span<const float, 3> dL_drgb, std::span<float> dL_draw) const;
};

}  // namespace nerf
