#pragma once

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// Finds the masks of photographs that have none yet: in a folder "masks" beside the photograph or
// beside its folder, named like the photograph with ".png" appended (COLMAP's convention) or in
// place of its extension. Black pixels are masked out.
void FindMasks(PosedImages& posed);

}  // namespace nerf::sfm
