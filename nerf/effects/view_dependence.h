#pragma once

#include "nerf/effects/effect.h"

namespace nerf {

// Whether colour depends on the direction from which it is seen, or, as a matt surface's, does not.
enum class ColorModel { kDiffuse, kViewDependent };

// Light that a surface sends into one direction and not into another: gloss, mirrors. With it the
// colour network sees the direction, as spherical harmonics (nerf/kernels/direction_encoding.h);
// without it that network has no weights for them.
struct ViewDependenceOptions {
  template <class Self, class Visitor>
  static void Options(Self&, Visitor&&) {}
};

// What the field's colours depend on where the effect is on or off.
constexpr ColorModel ColorModelOf(bool view_dependence) {
  return view_dependence ? ColorModel::kViewDependent : ColorModel::kDiffuse;
}

// The share of points whose colour changes from view to view by more than an error of a pixel, or
// another slant, could change it in their texture. Undecided where few points are seen often.
Verdict JudgeViewDependence(const TrackColors& colors, const PhotographFit& fit);

extern const EffectDescriptor kViewDependence;

}  // namespace nerf
