#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace nerf {

// Chooses cameras that stand for all: each has one of them near, in position and direction of view.
// Positions and directions count alike, positions relative to their spread. Minimizes the sum of
// the distances to the nearest chosen camera, greedily and then by swaps; deterministic, O(count
// N^2) for each round of swaps. Source: Kaufman and Rousseeuw 1990, "Finding Groups in Data",
// chapter 2 (k-medoids, PAM).
//   world_from_camera  OpenCV axes
//   count              at most the number of cameras
//   returns            indices, ascending
std::vector<std::size_t> RepresentativeCameras(
    const std::vector<Eigen::Isometry3d>& world_from_camera, std::size_t count);

}  // namespace nerf
