#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nerf/inspect/angle_residuals.h"
#include "nerf/inspect/verdict.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// What a capture calls for, found from what is there before anything is trained.
struct Inspection {
  std::vector<Verdict> verdicts;
  // Exposure of each photograph against the mean: as the sparse points show it, else as EXIF tells
  // of it; empty: unknown.
  std::vector<double> stops;
  std::vector<AngleResiduals> residuals;  // empty: no sparse points
  // NormalizeScene; where alpha bounds the scene, so that its ball is the unit ball.
  SceneNormalization normalized_from_world;
  std::string warning;  // about the input, one line; or empty
};

// Collects the evidence and lets every effect judge it.
//   read                  called with the number of photographs read
//   may_learn_background  else contracted space must hold what is far
// Throws InputError naming a mask that is broken.
Inspection Inspect(const PosedImages& posed, const std::function<void(int)>& read = {},
                   bool may_learn_background = true);

// What photographs alone show, before their poses are known: alpha, linear radiance, masks, EXIF.
//   photographs  without poses and cameras
// Throws InputError naming a mask that is broken.
Inspection InspectPhotographs(const PosedImages& photographs);

}  // namespace nerf
