#pragma once

#include <optional>

#include "nerf/inspect/verdict.h"
#include "nerf/inspect/visual_hull.h"
#include "sfm/posed_images.h"
#include "sfm/scene_normalization.h"

namespace nerf {

// Whether there is anything beyond a ball about what the cameras look at: only alpha can say that
// there is not.
//   hull  about what alpha leaves, radii; nullopt: it may reach far
Verdict JudgeUnbounded(bool alpha, const std::optional<Ball>& hull);

// What sparse points and cameras call for by where they are. There is at least one point.

// The share of points far beyond what the cameras look at.
Verdict JudgeBackground(const sfm::PosedImages& posed,
                        const sfm::SceneNormalization& normalized_from_world);

// Whether photographs alone leave open where matter stands.
Verdict JudgeDepth(const sfm::PosedImages& posed);

// How far points are, in the photographs, from where these cameras would see them: what structure
// from motion leaves over is a fraction of a pixel or one, and more where poses are wrong.
// Undecided where no track says where a point is seen.
Verdict JudgePoses(const sfm::PosedImages& posed);

// How much the scale changes at which photographs show the same point: what is one pixel from far
// away is many from nearby. Undecided where no point has a track.
Verdict JudgeFootprint(const sfm::PosedImages& posed);

// Where rays may begin: whatever stands nearer to a camera than most of the way to the nearest
// points is fog that nobody has seen.
Verdict JudgeNear(const sfm::PosedImages& posed,
                  const sfm::SceneNormalization& normalized_from_world);

}  // namespace nerf
