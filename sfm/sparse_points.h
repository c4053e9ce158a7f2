#pragma once

#include <filesystem>
#include <string>

#include "nerf/scene/posed_images.h"
#include "sfm/colmap_options.h"
#include "sfm/pose_consistency.h"

namespace nerf::sfm {

struct SparsePointReport {
  int points = 0;
  double track_length = 0;             // mean
  double mean_reprojection_error = 0;  // pixels, mean over the points
  PoseConsistency consistency;
  double seconds = 0;
};

// Finds sparse points for a capture whose poses and lenses are given: features by COLMAP, our
// matches, tracks, and triangulation with the given poses, which stay as they are. Features where a
// mask or alpha says that nothing is there are left out. The points replace those of `posed`; where
// the photographs contradict the poses, there are none.
//
// Writes to `workspace` as PosesFromPhotos does, but for models: a second call skips what is done.
// Throws InputError for a missing or failing COLMAP, fewer than two readable photographs, and a
// workspace that contains other files.
SparsePointReport FindSparsePoints(PosedImages& posed, const std::filesystem::path& workspace,
                                   const ColmapOptions& options);

// One line: "9,617 sparse points, each in 6.2 photographs, reprojection error 1.02 px, 13 s".
std::string Describe(const SparsePointReport& report);

}  // namespace nerf::sfm
