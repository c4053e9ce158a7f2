#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace nerf {

// A scalar function of space, by its values at the corners of cubic cells.
struct ScalarGrid {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();    // number of values along each axis
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // position of the first value
  double cell = 1;                                   // side of a cell
  std::vector<float> values;                         // x fastest, then y

  std::size_t Index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * size.y() + y) * size.x() + x;
  }
  Eigen::Vector3d PositionOf(int x, int y, int z) const {
    return origin + cell * Eigen::Vector3d(x, y, z);
  }

  // Trilinear between the values; outside the grid, that of the nearest point of it.
  double At(const Eigen::Vector3d& position) const;
  // By central differences over a cell in both directions.
  Eigen::Vector3d Gradient(const Eigen::Vector3d& position) const;
};

// Blurs the values along each axis by a Gaussian; beyond the border they go on as they are there.
//   sigma  standard deviation, in cells; 0: nothing is done
void Blur(ScalarGrid& grid, double sigma);

}  // namespace nerf
