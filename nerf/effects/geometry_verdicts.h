#pragma once

#include <optional>

#include "nerf/inspect/verdict.h"
#include "nerf/inspect/visual_hull.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// Whether there is anything beyond a ball about what the cameras look at, of photographs with
// alpha.
//   hull  about what alpha leaves, radii; nullopt: it may reach far
Verdict JudgeUnbounded(const std::optional<Ball>& hull);

// What sparse points and cameras call for by where they are. There is at least one point.

// Where the sparse points are, in radii of what the cameras look at.
struct PointShares {
  double far = 0;      // beyond what parallax tells apart
  double between = 0;  // behind what is near, and not far
  Ball near;           // about the others, with a margin
};
PointShares SharesOfPoints(const PosedImages& posed,
                           const SceneNormalization& normalized_from_world);

// Of photographs without alpha. Where points are near or far and nowhere between, what is far is a
// background and rays may end at the ball about what is near. Where they are everywhere, contracted
// space holds the far ones too.
bool IsBeforeBackground(const PointShares& shares);
//   learned  whether a background may be learned; else contracted space must hold what is far
Verdict JudgeUnbounded(const PointShares& shares, bool learned);
Verdict JudgeBackground(const PointShares& shares);

// Whether photographs alone leave open where matter stands, of what is not far.
Verdict JudgeDepth(const PosedImages& posed, const SceneNormalization& normalized_from_world);

// How far points are, in the photographs, from where these cameras would see them: what structure
// from motion leaves over is a fraction of a pixel or one, and more where poses are wrong.
// Undecided where no track says where a point is seen.
Verdict JudgePoses(const PosedImages& posed);

// How much the scale changes at which photographs show the same point: what is one pixel from far
// away is many from nearby. Undecided where no point has a track.
Verdict JudgeFootprint(const PosedImages& posed);

// Where rays may begin: whatever stands nearer to a camera than most of the way to the nearest
// points is fog that nobody has seen.
Verdict JudgeNear(const PosedImages& posed, const SceneNormalization& normalized_from_world);

}  // namespace nerf
