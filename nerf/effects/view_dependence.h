#pragma once

#include "nerf/effects/effect.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

struct PhotographFit;
struct TrackColors;

// Whether colour depends on the viewing direction or not, as on a matt surface.
enum class ColorModel { kDiffuse, kViewDependent };

// Radiance that depends on the viewing direction: gloss, mirrors. With it the direction is an input
// of the colour network, as spherical harmonics (nerf/kernels/direction_encoding.h); without it
// that network has no weights for them.
struct ViewDependenceOptions {
  template <class Self, class Visitor>
  static void Options(Self&, Visitor&&) {}
};

// The colour model of the field where the effect is on or off.
constexpr ColorModel ColorModelOf(bool view_dependence) {
  return view_dependence ? ColorModel::kViewDependent : ColorModel::kDiffuse;
}

// Judges by the share of points whose colour changes between views by more than their local texture
// explains (an error of a pixel, another slant). Undecided where too few points have long tracks.
// Where most sightings of points are missing, few changing points are no evidence that there is no
// gloss: the verdict is inconclusive.
//   posed  with the points, for SightedShare
Verdict JudgeViewDependence(const TrackColors& colors, const PhotographFit& fit,
                            const PosedImages& posed);

extern const EffectDescriptor kViewDependenceEffect;

}  // namespace nerf
