#pragma once

#include <filesystem>

#include "nerf/train/model.h"
#include "sfm/posed_images.h"

namespace nerf {

// Where the training refined poses: says how far they went, and writes RUN/refined_transforms.json,
// the cameras of the photographs that were trained on as they are now, in the input's frame and
// units. Focal lengths count as those of a lens without distortion.
void ReportRefinedPoses(const Model& model, const sfm::PosedImages& posed,
                        const std::filesystem::path& run);

}  // namespace nerf
