#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "nerf/appearance/environment_map.h"
#include "nerf/appearance/lights.h"

namespace nerf::appearance {

// The patch of the sphere for which each light of a capture stands. On a full grid of latitude and
// longitude (about y) a patch lies between the middles of neighbouring rows and columns, and its
// solid angle is that of the sin term, sin(theta) dtheta dphi; anywhere else it is the light's
// Voronoi cell, all directions to which it is the nearest.
// The sphere is cut into the pixels of a latitude-longitude picture, each of which belongs to one
// light: so the patches cover it without gap or overlap, and no light of an environment is lost
// between two of them.
class LightVoronoi {
 public:
  // height  rows of that picture, twice as many columns; edges of cells are as fine as its pixels
  // Throws sfm::InputError where there are no lights.
  LightVoronoi(std::span<const DirectionalLight> lights, int height);

  // Solid angle of each light's patch, sr; they sum to 4 pi.
  std::vector<double> SolidAngles() const;

  // The integral of an environment's radiance over each light's patch: the map filtered to the
  // lights' density, times its solid angle. W / m^2.
  //   degrees  turns the environment about y, counter-clockwise seen from above, in whole pixels
  // The map has the height that was given to the constructor.
  std::vector<Color> Integrate(const EnvironmentMap& map, double degrees = 0) const;

  bool on_a_grid() const { return on_a_grid_; }

 private:
  int light_count_;
  bool on_a_grid_ = false;
  int height_;
  std::vector<int> light_of_pixel_;
};

}  // namespace nerf::appearance
