#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "sfm/colmap_database.h"
#include "sfm/feature_matching.h"

namespace nerf::sfm {

// Matches of two photographs that agree with one geometry, whatever the poses, and where they are.
struct SeenTwice {
  ImagePair images;                                  // indices into PosedImages::images
  std::vector<Eigen::Vector2d> in_first, in_second;  // pixels
};

// How many of an image's matches fit the poses: near the epipolar line, and in front of both
// cameras. At most 60 of each pair are looked at.
struct ImageFit {
  int matches = 0, fitting = 0;
};
// For each of posed.images.
//   max_error  pixels
std::vector<ImageFit> FitOfImages(const PosedImages& posed, std::span<const SeenTwice> matches,
                                  double max_error);

// How well poses and lenses agree with what the photographs show.
struct PoseConsistency {
  // Share of the matches that fit the given poses (ImageFit). NaN where there are too few to tell.
  double share = 0;
  // What would explain them better, as the rest of a sentence; empty where the poses fit, or
  // nothing that is known does.
  std::string looks_like;
  double share_then = 0;

  // The poses are useless as they are.
  bool Contradicts() const;
  // Worth a warning: they are, or a known mistake explains what does not fit.
  bool IsDoubtful() const { return Contradicts() || !looks_like.empty(); }
};

// One line, without the name of the input.
std::string Describe(const PoseConsistency& consistency);

// Compares the poses with matches, and where they do not fit, tries common mistakes: poses
// inverted, axes of the camera or the world flipped, another focal length, names that are shifted
// or reversed.
PoseConsistency CheckPoses(const PosedImages& posed, std::span<const SeenTwice> matches);

}  // namespace nerf::sfm
