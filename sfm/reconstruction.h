#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "sfm/colmap_images.h"
#include "sfm/colmap_options.h"
#include "sfm/photo_folder.h"
#include "sfm/reconstruction_verdict.h"

namespace nerf::sfm {

struct Reconstruction {
  std::filesystem::path model;
  PosedImages posed;  // with COLMAP's names; no images where nothing was found
  ReconstructionVerdict verdict;
  int misplaced = 0;       // photographs that were left out of the model
  int largest_broken = 0;  // photographs in the largest model that was not trusted
  std::vector<std::pair<std::string, double>> seconds;  // per step
  std::filesystem::path log;                            // folder
};

// Reconstructs photographs with COLMAP, and spends more where the result is not good: all pairs
// instead of the most similar ones, then more and finer features, and only then lower thresholds of
// the mapper. Says in the log which step was taken, and why. Of all models takes the one with most
// photographs that is not broken, if it has a fifth of those of a broken one; a good one also
// instead of a doubtful one with up to a tenth more. Leaves out photographs that are misplaced.
//   files, photos, plan  as for ColmapSteps::PrepareImages
//   matcher              as for ColmapSteps::Match
Reconstruction Reconstruct(const std::filesystem::path& workspace, const ColmapOptions& options,
                           const std::vector<PhotoFile>& files, const std::vector<Photo>& photos,
                           const std::vector<ColmapImage>& plan, const std::string& matcher);

// Judges a model that Reconstruct has left in its workspace, by the matches that are still there.
//   model    its folder, as FindInput returns it
//   returns  nothing for models of other programs
std::optional<ReconstructionVerdict> JudgeAgain(const std::filesystem::path& model,
                                                const PosedImages& posed);

}  // namespace nerf::sfm
