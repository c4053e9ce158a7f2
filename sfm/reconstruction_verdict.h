#pragma once

#include <span>
#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "sfm/colmap_database.h"
#include "sfm/pose_consistency.h"

namespace nerf::sfm {

enum class Trust {
  kGood,
  kDoubtful,  // may serve, but some of it is probably wrong
  kBroken,    // most of it is probably wrong
};

// What tells whether a reconstruction can be trusted.
struct ReconstructionFigures {
  int registered = 0, points = 0;
  double observations = 0;     // of points in a photograph, median
  double track_length = 0;     // photographs that see a point, mean
  double angle = 0;            // between the rays to a point, the largest of each, median; degrees
  double fitting = 0;          // share of the matches of two photographs that fit their poses
  std::vector<int> misplaced;  // photographs of which less than 80 % of the matches fit; indices
  // How far photographs stand from where smaller models have them, the largest median; degrees.
  double disagreement = 0;
  double far = 0;  // share of the points beyond 8 radii of what the cameras look at
};

struct ReconstructionVerdict {
  Trust trust = Trust::kGood;
  bool features_may_help = false;  // more and finer ones, against what is wrong
  ReconstructionFigures figures;
  std::string reason;  // why it is not good, with what to photograph next time; empty if it is
};

// The matches of a database between the images of a model, by name: those of the six strongest
// pairs of each. Of photographs that do not overlap, some matches agree with a geometry by chance.
std::vector<SeenTwice> MatchesOf(const PosedImages& model, const ColmapDatabase& database);

// Judges a model by matches that the mapper did not choose: each pair is verified for itself.
// Without any there is nothing to judge by, and it is taken for good.
ReconstructionVerdict JudgeReconstruction(const PosedImages& model,
                                          std::span<const SeenTwice> matches);

// Compares a model with others of the same photographs, each put over it as well as it can be:
// those that share eight photographs or more. A model in which they stand elsewhere is doubtful,
// although each pair may fit: parts were joined wrongly, or bent.
void JudgeAgreement(const PosedImages& model, std::span<const PosedImages> others,
                    ReconstructionVerdict& verdict);

// A model without some of its images, by index, ascending; and without points that fewer than two
// of the others see.
PosedImages WithoutImages(const PosedImages& model, const std::vector<int>& images);

std::string_view NameOf(Trust trust);
// "good: 98 % of the matches fit the poses, 300 points in a photograph, ...", one line.
std::string Describe(const ReconstructionVerdict& verdict);

}  // namespace nerf::sfm
