#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "sfm/colmap_options.h"
#include "sfm/photo_folder.h"

namespace nerf::sfm {

struct ColmapReport {
  int photos = 0;  // those that can be read
  int registered = 0;
  int points = 0;
  double mean_reprojection_error = 0;  // pixels, mean over the points
  std::vector<SkippedPhoto> skipped;   // those that cannot be read
  std::vector<std::string> unregistered;
  std::vector<std::pair<std::string, double>> seconds;  // step by step; as it was when it ran
};

// From a folder of photographs to their poses, with the COLMAP program that is installed, on the
// CPU: features, matches, incremental mapping; once more with all pairs where a guided match left
// one in ten photographs unregistered, and with lower thresholds where half of them. Of all models,
// the one with most registered images counts.
//
// All files go below `workspace`: images/ (what COLMAP sees), database.db, sparse/, log/ and
// steps.json, by which a second call skips what is finished and goes on with an interrupted match.
// A changed photograph or option repeats the steps that depend on it.
//
//   returns  images with the name and path of the original photographs, in COLMAP's frame and
//            unit (arbitrary), cameras of the upright photographs, sparse points with tracks.
//            Warns where less than nine in ten photographs were registered.
// Throws InputError for a folder without two readable photographs, a workspace that holds other
// people's files, COLMAP missing or failing, and fewer than 4 photographs or a tenth registered.
PosedImages PosesFromPhotos(const std::filesystem::path& photo_folder,
                            const std::filesystem::path& workspace, const ColmapOptions& options,
                            ColmapReport* report = nullptr);

// Whether names, sorted, count as one numbered sequence: the same text before and after a number
// of the same width, at least half of whose values between the first and the last are there.
bool IsNumberedSequence(const std::vector<std::string>& names);

}  // namespace nerf::sfm
