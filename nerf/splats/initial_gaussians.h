#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nerf/splats/gaussian_cloud.h"

namespace nerf {

// A point of a surface from which a Gaussian can begin.
struct ColoredPoint {
  Eigen::Vector3d x_in_normalized;
  Eigen::Vector3f rgb;  // as photographs show it, 0 to 1
};

// Gaussians at points: round, of a standard deviation of 0.42 times the root mean square distance
// to the three nearest points, and of an opacity of 0.8. Of more points than Gaussians an even
// random subset is taken; where there are fewer, the others are invisible, and fitting puts them
// where they are needed.
GaussianCloud GaussiansAtPoints(const std::vector<ColoredPoint>& points, std::int64_t count,
                                int order, std::uint64_t seed);

}  // namespace nerf
