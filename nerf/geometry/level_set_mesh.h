#pragma once

#include "nerf/geometry/mesh.h"
#include "nerf/geometry/scalar_grid.h"

namespace nerf {

// The surface where a function has a value, as triangles whose front is on the side of larger
// values (outside, for a signed distance). Closed, also where it meets the border of the grid. By
// OpenVDB: dual contouring, one vertex a cell. Each vertex has a normal, the direction of the
// gradient; where the gradient is 0, it is 0: invalid. Empty if the function has the value nowhere.
Mesh LevelSetMesh(const ScalarGrid& grid, double level);

}  // namespace nerf
