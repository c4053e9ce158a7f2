#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "nerf/light/environment_map.h"
#include "nerf/light/lights.h"

namespace nerf {

// The patch of the sphere for which each light of a capture stands. On a full grid of latitude and
// longitude (about y) a patch lies between the middles of neighbouring rows and columns, and its
// solid angle is that of the sin term, sin(theta) dtheta dphi; anywhere else it is the light's
// Voronoi cell, all directions to which it is the nearest.
// The sphere is cut into the pixels of a latitude-longitude picture, each of which belongs to one
// light: so the patches do not overlap, and no light of an environment is lost between two of them.
// Where the lights cover part of the sphere only, what lies farther from all of them than twice
// their typical distance (the median to a light's nearest neighbour) belongs to none: no image
// shows the subject lit from there. A grid covers the whole sphere.
class LightVoronoi {
 public:
  // height  rows of that picture, twice as many columns; edges of cells are as fine as its pixels.
  //         See CellRows.
  // Throws InputError where there are no lights.
  LightVoronoi(std::span<const DirectionalLight> lights, int height);

  // Solid angle of each light's patch, sr; they sum to 4 pi where the lights are all around.
  std::vector<double> SolidAngles() const;

  // The integral of an environment's radiance over each light's patch: the map filtered to the
  // lights' density, times its solid angle. W / m^2.
  //   degrees  turns the environment about y, counter-clockwise seen from above, in whole pixels
  // The height that was given to the constructor is that of the map, or a multiple of it.
  std::vector<Color> Integrate(const EnvironmentMap& map, double degrees = 0) const;

  // The share of an environment's luminous power that comes from where no light stands, and that
  // Integrate leaves out; in [0,1], 0 for a black map.
  double ShareLeftOut(const EnvironmentMap& map, double degrees = 0) const;

  bool on_a_grid() const { return on_a_grid_; }

 private:
  // Sums by light, and last what belongs to none.
  std::vector<Color> Sums(const EnvironmentMap& map, double degrees) const;

  int light_count_;
  bool on_a_grid_ = false;
  int height_;
  std::vector<int> light_of_pixel_;  // light_count_: of none
};

// Rows of the cells' picture for a map: those of the map, or so many times more that each of the
// lights has about 100 pixels.
int CellRows(int lights, int map_height);

}  // namespace nerf
