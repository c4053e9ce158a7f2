#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "nerf/light/environment_map.h"
#include "nerf/light/lights.h"

namespace nerf {

// Partitions the sphere of directions among the lights of a capture. If the lights are on a full
// grid of latitude and longitude (about y), a cell is bounded by the midpoints between neighbouring
// rows and columns, and its solid angle is sin(theta) dtheta dphi. Otherwise it is the Voronoi cell
// of the light: all directions to which it is the nearest. The cells are made of the pixels of a
// latitude-longitude image, each of which belongs to one light; so they do not overlap, and no
// small light of an environment falls between two cells. If the lights cover only part of the
// sphere, directions farther from all lights than twice the median distance between neighbouring
// lights belong to no cell, because no image shows the subject lit from there. A grid covers the
// whole sphere.
class LightVoronoi {
 public:
  //   height  rows of that image, which has twice as many columns; see CellRows
  // Throws InputError if there are no lights.
  LightVoronoi(std::span<const DirectionalLight> lights, int height);

  // The solid angle of each cell, sr; their sum is 4 pi if the lights cover the sphere.
  std::vector<double> SolidAngles() const;

  // The integral of the radiance of an environment over each cell, W / m^2. The height of the cells
  // must be a multiple of the height of the map.
  //   degrees  rotation of the environment about y, counter-clockwise as seen from above; rounded
  //            to whole pixels
  std::vector<Color> Integrate(const EnvironmentMap& map, double degrees = 0) const;

  // The fraction of the luminous power of an environment that comes from directions without a cell,
  // in [0,1]; 0 for a black map.
  double UncoveredFraction(const EnvironmentMap& map, double degrees = 0) const;

  bool on_a_grid() const { return on_a_grid_; }

 private:
  // The integrals over the cells, and last that over the directions without a cell.
  std::vector<Color> Sums(const EnvironmentMap& map, double degrees) const;

  int light_count_;
  bool on_a_grid_ = false;
  int height_;
  std::vector<int> light_of_pixel_;  // [pixel]; light_count_: no cell
};

// A good height of the cell image for a map: a multiple of the height of the map, with at least 100
// pixels per light on average.
int CellRows(int lights, int map_height);

}  // namespace nerf
