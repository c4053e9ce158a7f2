#pragma once

#include <filesystem>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// Writes cameras.txt, images.txt and points3D.txt of a COLMAP model, so that ReadColmapModel (and
// COLMAP itself) gives lenses, poses, points and tracks back. Format: COLMAP documentation "Output
// Format". The folder must be there; each file appears whole or not at all. Throws InputError when
// one cannot be written.
void WriteColmapText(const PosedImages& posed, const std::filesystem::path& folder);

}  // namespace nerf::sfm
