#pragma once

#include "nerf/effects/background_map.h"
#include "nerf/geometry/rays.h"

namespace nerf {

// The rays with what the map shows in their directions as their background.
RayBatch WithBackground(const RayBatch& rays, const BackgroundMap& map);

}  // namespace nerf
