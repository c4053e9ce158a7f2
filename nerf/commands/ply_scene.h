#pragma once

#include <filesystem>
#include <memory>

#include "nerf/commands/shots.h"
#include "nerf/model/gaussian_model.h"

namespace nerf {

// Gaussians of a PLY file, in its frame and units, before black; warns of those that are left out.
// Throws InputError naming the file.
std::shared_ptr<const GaussianModel> OpenPly(const std::filesystem::path& file);

// The views to render of a scene that has no cameras of its own: those of a pose or a path file. A
// pose without a lens has 800x600 pixels and a vertical field of view of 50 degrees.
// Throws InputError for other options.
ShotList ChoosePlyShots(const ShotOptions& options, const std::filesystem::path& file);

}  // namespace nerf
