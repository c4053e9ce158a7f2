#pragma once

#include "nerf/model/model.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Applies a model's pose refinement to its photographs, in the input's frame and units: to the
// poses of training photographs and to the focal lengths of all lenses, which held-out photographs
// share. Focal lengths are scaled as for a lens without distortion. Returns `posed` unchanged if
// the model has no pose refinement.
PosedImages RefinedPoses(const Model& model, PosedImages posed);

}  // namespace nerf
