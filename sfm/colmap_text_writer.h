#pragma once

#include <filesystem>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// Writes a COLMAP model as cameras.txt, images.txt and points3D.txt, with lenses, poses, points and
// tracks, for ReadColmapModel and COLMAP itself. Format: COLMAP documentation "Output Format". The
// folder must exist; each file is written atomically. Throws InputError when one cannot be written.
void WriteColmapText(const PosedImages& posed, const std::filesystem::path& folder);

}  // namespace nerf::sfm
