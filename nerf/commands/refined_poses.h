#pragma once

#include <filesystem>

#include "nerf/train/model.h"
#include "sfm/posed_images.h"

namespace nerf {

// Where the training refined poses: says how far they went, and writes RUN/refined_transforms.json
// (RefinedPoses).
void ReportRefinedPoses(const Model& model, const sfm::PosedImages& posed,
                        const std::filesystem::path& run);

}  // namespace nerf
