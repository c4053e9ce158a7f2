#pragma once

#include "nerf/inspect/verdict.h"
#include "sfm/posed_images.h"

namespace nerf {

// What sparse points and cameras call for by where they are. There is at least one point.

// The share of points far beyond what the cameras look at.
Verdict JudgeBackground(const sfm::PosedImages& posed);

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
Verdict JudgeNear(const sfm::PosedImages& posed);

}  // namespace nerf
