#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nerf/inspect/angle_residuals.h"
#include "nerf/inspect/verdict.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// The effects that a capture calls for, decided before anything is trained.
struct Inspection {
  std::vector<Verdict> verdicts;
  // Exposure of each photograph relative to the mean, log2: from the sparse points, else from EXIF;
  // empty: unknown.
  std::vector<double> stops;
  std::vector<AngleResiduals> residuals;  // empty: no sparse points
  // NormalizeScene; where the scene is bounded, the frame in which its ball is the unit ball.
  SceneNormalization normalized_from_world;
  std::string warning;  // about the input, one line; or empty
};

// Collects the evidence, and the verdict of every effect on it.
//   read                  called with the number of photographs read
//   may_learn_background  if false, contracted space has to represent distant points
// Throws InputError naming a mask that is broken.
Inspection Inspect(const PosedImages& posed, const std::function<void(int)>& read = {},
                   bool may_learn_background = true);

// As Inspect, from photographs alone, before poses are known: alpha, linear radiance, masks, EXIF.
//   photographs  without poses and cameras
// Throws InputError naming a mask that is broken.
Inspection InspectPhotographs(const PosedImages& photographs);

}  // namespace nerf
