#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "nerf/geometry/ball.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// A ball around the visual hull of photographs with alpha (40 at most), computed in cells of 1/16
// normalized unit. A cell is empty where a photograph sees it entirely and only transparent pixels
// there, and where too few photographs see it. Source: Laurentini 1994, "The visual hull concept
// for silhouette-based image understanding".
//   read     called with the number of photographs read
//   returns  normalized frame; nullopt where the hull is empty, or reaches the border of the cube
//            [-2,2]^3 and so may extend beyond it
// A photograph that cannot be read is skipped.
std::optional<Ball> BoundingBallOfHull(const PosedImages& posed,
                                       const SceneNormalization& normalized_from_world,
                                       const std::function<void(int)>& read = {});

// The normalization under which a ball, given in the frame of the old one, is the unit ball.
SceneNormalization NormalizedTo(const Ball& ball, SceneNormalization normalized_from_world);

}  // namespace nerf
