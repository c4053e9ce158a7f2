#pragma once

#include <vector>

#include "nerf/sampling/occupancy_grid.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// Empties for good the cells of the grid that no view sees, with a margin of the cell's own size: a
// cell counts as seen when the ball around it touches the picture of some view.
void KeepVisibleCells(OccupancyGrid& grid, const std::vector<View>& views);

}  // namespace nerf
