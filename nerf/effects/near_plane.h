#pragma once

#include "nerf/effects/effect.h"

namespace nerf {

// Where rays may begin (march.near_distance): whatever stands nearer to a camera than most of the
// way to the nearest points is fog that no photograph shows. No effect, but decided as they are.
//   posed  with points and tracks
Verdict JudgeNearPlane(const PosedImages& posed, const SceneNormalization& normalized_from_world);

}  // namespace nerf
