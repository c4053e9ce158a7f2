#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace nerf {

// Chooses cameras that stand for all. They are divided into groups of similar position and
// direction of view (positions relative to their spread), so that the sum of the distances to the
// middle camera of each group is small: greedily and then by swaps; deterministic, O(count N^2) for
// each round of swaps. Of each group the one at the median distance from the middle is taken.
// Source: Kaufman and Rousseeuw 1990, "Finding Groups in Data", chapter 2 (k-medoids, PAM).
//   world_from_camera  OpenCV axes
//   count              at most the number of cameras
//   returns            indices, ascending
std::vector<std::size_t> RepresentativeCameras(
    const std::vector<Eigen::Isometry3d>& world_from_camera, std::size_t count);

}  // namespace nerf
