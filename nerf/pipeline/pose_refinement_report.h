#pragma once

#include <filesystem>

#include "nerf/model/model.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Where the training refined poses: says how far they went, and writes RUN/refined_transforms.json
// (RefinedPoses).
void ReportRefinedPoses(const Model& model, const PosedImages& posed,
                        const std::filesystem::path& run);

}  // namespace nerf
