#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "nerf/scene/posed_images.h"

namespace nerf {

// COLMAP's name ("OPENCV") and number of parameters of a camera model.
std::string_view CameraModelName(CameraModel model);
int CameraModelNumParams(CameraModel model);
std::optional<CameraModel> CameraModelFromName(std::string_view name);
std::optional<CameraModel> CameraModelFromId(int id);

// What to do about a lens that is not supported, for messages.
//   name  of its model in COLMAP or nerfstudio, or a number
std::string UnsupportedLens(std::string_view name);

}  // namespace nerf
