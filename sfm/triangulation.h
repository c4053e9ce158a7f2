#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// The figures of COLMAP's mapper.
struct TriangulationOptions {
  double max_error = 4;    // of a projection, pixels
  double min_angle = 1.5;  // largest between two rays, degrees
  std::size_t min_views = 3;
};

// The point that two rays come nearest to, in front of both.
//   returns  nothing where it is behind one, or the rays are parallel
std::optional<Eigen::Vector3d> NearestToRays(const Eigen::Vector3d& origin_a,
                                             const Eigen::Vector3d& direction_a,
                                             const Eigen::Vector3d& origin_b,
                                             const Eigen::Vector3d& direction_b);

// The point that a track shows, given lenses and poses: the pair of rays that most others agree
// with, then least squares of the projections through the lens. Sightings that disagree are left
// out of the track.
//   returns  nothing where fewer agree than the options ask for, or their rays are too parallel.
//            Without a colour
std::optional<SparsePoint> Triangulate(const PosedImages& posed,
                                       std::span<const TrackElement> track,
                                       const TriangulationOptions& options = {});

}  // namespace nerf::sfm
