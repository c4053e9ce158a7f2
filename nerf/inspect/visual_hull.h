#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "nerf/geometry/ball.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// A small ball about what the alpha of photographs, 40 at most, leaves: the visual hull, in cells
// of a sixteenth of the normalized unit. A cell is empty where a photograph sees all of it and
// nothing but transparent pixels there, and where hardly a photograph sees it. Source: Laurentini
// 1994, "The visual hull concept for silhouette-based image understanding".
//   returns  normalized frame; nullopt where cells are left at the border of the cube [-2,2]^3:
//            then there may be matter beyond
//   read     called with the number of photographs read
// A photograph that cannot be read is left out.
std::optional<Ball> BallAboutHull(const PosedImages& posed,
                                  const SceneNormalization& normalized_from_world,
                                  const std::function<void(int)>& read = {});

// The frame in which a ball of the other is the unit ball.
SceneNormalization FittedTo(const Ball& ball, SceneNormalization normalized_from_world);

}  // namespace nerf
