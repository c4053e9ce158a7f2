#pragma once

namespace nerf {

// Whether colour depends on the direction from which it is seen, or, as a matt surface's, does not.
enum class ColorModel { kDiffuse, kByDirection };

// Light that a surface sends into one direction and not into another: gloss, mirrors. With it the
// colour network sees the direction, as spherical harmonics (nerf/kernels/direction_encoding.h);
// without it that network has no weights for them.
struct ViewOptions {};

// What the field's colours depend on where the effect is there or is not.
constexpr ColorModel ColorModelWith(bool view) {
  return view ? ColorModel::kByDirection : ColorModel::kDiffuse;
}

}  // namespace nerf
