#pragma once

#include <vector>

#include "nerf/sampling/occupancy_grid.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// Permanently marks as empty the cells of the grid that are outside all view frustums. A cell is
// kept if its bounding sphere touches the frustum of some view.
void KeepVisibleCells(OccupancyGrid& grid, const std::vector<View>& views);

}  // namespace nerf
