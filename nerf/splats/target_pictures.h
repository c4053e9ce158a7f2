#pragma once

#include <vector>

#include "nerf/scene/view.h"
#include "nerf/splats/picture_loss.h"

namespace nerf {

// The photograph of a view; pixels that it does not store have a weight of 0.
TargetPicture TargetOf(const View& view);

}  // namespace nerf
