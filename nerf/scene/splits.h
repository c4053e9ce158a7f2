#pragma once

#include "nerf/scene/data_options.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Marks each image as train, validation or test, in place. A split that the source defines is kept;
// otherwise images are counted in the order of their names. With fewer than 8 images none is held
// out; with fewer than 16 left for training there is no
// validation split. Validation images are taken where their cameras stand for all.
void AssignSplits(PosedImages& posed, const DataOptions& options);

}  // namespace nerf
