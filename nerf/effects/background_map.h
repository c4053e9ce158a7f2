#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nerf/data/image.h"

namespace nerf {

// Surroundings without end, behind everything, that differ in each direction (Background).
struct BackgroundOptions {
  // Rows of the map; it has twice as many columns. Few photographs look into one direction: of a
  // finer map each paints its own part, with what stands before the background in it (16 was best
  // of 8, 16, 32 and 128 on a photograph for validation).
  int resolution = 16;

  void Check() const;
};

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

  // Makes each texel the median of the colours that photographs show in its direction; where they
  // show none, the mean of the texels beside it.
  //   direction [R,3], rgb [R,3] in the encoding of the field
  void SetToMedians(std::span<const float> direction, std::span<const float> rgb);

  // direction, rgb [R,3]
  void Radiance(std::span<const float> direction, std::span<float> rgb) const;

  // The way back of one ray: adds to dL_draw, which is laid out as raw.
  void AddGradient(std::span<const float, 3> direction, std::span<const float, 3> rgb,
                   std::span<const float, 3> dL_drgb, std::span<float> dL_draw) const;
};

}  // namespace nerf
