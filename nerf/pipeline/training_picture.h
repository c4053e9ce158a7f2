#pragma once

#include <filesystem>
#include <optional>

#include "nerf/model/scene_model.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Shows what a training reached: RUN/picture.png, a photograph (held out, if there is one), the
// rendering from its pose, and their difference. Quick: at most 640 pixels wide or high.
//   returns  the file; nullopt if the photograph cannot be read, or is tiny
//   quality  of the rendering
//   posed    with refined poses, if the model has them
std::optional<std::filesystem::path> WriteTrainingPicture(const SceneModel& model, double quality,
                                                          const PosedImages& posed,
                                                          const std::filesystem::path& run);

}  // namespace nerf
