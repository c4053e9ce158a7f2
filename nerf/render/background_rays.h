#pragma once

#include "nerf/effects/background_map.h"
#include "nerf/geometry/rays.h"

namespace nerf {

// Copies the rays and sets their backgrounds to the map's colours in their directions.
RayBatch WithBackground(const RayBatch& rays, const BackgroundMap& map);

}  // namespace nerf
