#pragma once

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// Looks for the masks of photographs that have none yet: in a folder "masks" beside the photograph
// or beside its folder, under the photograph's name and ".png" (COLMAP's convention), or under that
// name with .png for its ending. Black marks the pixels that are masked out.
void FindMasks(PosedImages& posed);

}  // namespace nerf::sfm
