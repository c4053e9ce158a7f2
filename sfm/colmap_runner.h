#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "sfm/colmap_options.h"
#include "sfm/photo_folder.h"
#include "sfm/reconstruction_verdict.h"

namespace nerf::sfm {

struct ColmapReport {
  int photos = 0;  // readable photographs
  int registered = 0;
  int points = 0;
  double mean_reprojection_error = 0;  // pixels, mean over the points
  ReconstructionVerdict verdict;
  int misplaced = 0;       // photographs that were left out: their matches contradict their poses
  int largest_broken = 0;  // photographs in the largest model that was not trusted
  std::vector<SkippedPhoto> skipped;  // photographs that cannot be read
  std::vector<std::string> unregistered;
  std::vector<std::pair<std::string, double>> seconds;  // per step, of the run that executed it
};

// Computes the poses of a folder of photographs with the installed COLMAP program, on the CPU:
// feature extraction, our matching, and incremental mapping; with more effort where the result is
// not good (Reconstruct).
//
// Writes to `workspace`: images/ (the input of COLMAP), database.db, sparse/, log/ and steps.json,
// by which a second call skips finished steps and continues an interrupted match. Steps whose
// photographs or options have changed are repeated.
//
//   returns  images with the name and path of the original photographs, in COLMAP's arbitrary frame
//            and unit, cameras of the upright photographs, sparse points with tracks
// Warns where less than nine in ten photographs are registered. Throws InputError for a folder with
// fewer than two readable photographs, a workspace that contains other files, a missing or failing
// COLMAP, and fewer than 4 photographs, or less than a tenth, registered.
PosedImages PosesFromPhotos(const std::filesystem::path& photo_folder,
                            const std::filesystem::path& workspace, const ColmapOptions& options,
                            ColmapReport* report = nullptr);

// Whether sorted names form a numbered sequence: the same text before and after a number of the
// same width, with at least half of the values between the first and the last.
bool IsNumberedSequence(const std::vector<std::string>& names);

}  // namespace nerf::sfm
