#pragma once

#include "nerf/geometry/ball.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// In radii of what the cameras look at. Beyond a larger ball than kNearRadius the middle of the
// scene is resolved more finely in contracted space.
inline constexpr double kNearRadius = 1.5;
inline constexpr double kFarRadius = 8;  // from there on parallax does not tell distances apart

// Where the sparse points are.
struct PointShares {
  double far = 0;      // share of the points beyond kFarRadius
  double between = 0;  // share of the points between kNearRadius and kFarRadius
  Ball near;           // about the others, with a margin
};
//   posed  with one point at least
PointShares SharesOfPoints(const PosedImages& posed,
                           const SceneNormalization& normalized_from_world);

// Of the photographs with a point in their frame, the share whose track sees it; the median of the
// points. What is in the way lowers it, and much more so a matcher, which loses a point where its
// surroundings look different: it finds few points on glossy surfaces.
double SightedShare(const PosedImages& posed);

// Of photographs without alpha: whether points are near or far and hardly any in between. What is
// far is then a background, and rays may end at the ball about what is near. Where points are
// everywhere, contracted space holds the far ones too.
bool IsBeforeBackground(const PointShares& shares);
inline constexpr double kFarAway = 0.007;  // share of far points that makes a background

}  // namespace nerf
