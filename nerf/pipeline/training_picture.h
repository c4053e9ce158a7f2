#pragma once

#include <filesystem>
#include <optional>

#include "nerf/model/model.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Shows what a training reached: RUN/picture.png, a photograph (held out, if there is one), the
// rendering from its pose, and their difference. Quick: at most 640 pixels wide or high, and at a
// rendering quality of 0.5.
//   returns  the file; nullopt if the photograph cannot be read, or is tiny
std::optional<std::filesystem::path> WriteTrainingPicture(const Model& model,
                                                          const PosedImages& posed,
                                                          const std::filesystem::path& run);

}  // namespace nerf
