#pragma once

#include "nerf/model/model.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// The photographs as a model with refined poses knows them, in the input's frame and units: poses
// of those that it was trained on, focal lengths of the lenses that took them, and so of
// photographs that were held out, too. Focal lengths count as those of a lens without distortion.
// The same where the model refines none.
PosedImages RefinedPoses(const Model& model, PosedImages posed);

}  // namespace nerf
