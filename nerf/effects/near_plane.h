#pragma once

#include "nerf/inspect/verdict.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// The near plane (march.near_distance): 0.7 of the distance from a camera to its nearest points.
// Density closer than that would be floaters. Not an effect, but decided in the same way.
//   posed  with points and tracks
Verdict JudgeNearPlane(const PosedImages& posed, const SceneNormalization& normalized_from_world);

}  // namespace nerf
