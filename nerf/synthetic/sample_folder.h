#pragma once

#include <filesystem>

#include "nerf/synthetic/sample_options.h"

namespace nerf::synthetic {

// Renders the scene of options.scenario into a folder, which is created if it does not exist:
//   images/view_000.png, ...        photographs, 8-bit sRGB (kHdr: .exr, radiance): all that
//                                   structure from motion and training may use
//   masks/view_000.png              only kMasks
//   truth/transforms.json           poses of ../images: true ones, except in kPoseRefinement
//   truth/sparse/                   the same poses as a COLMAP model, with points and their tracks
//   truth/poses.json                only kPoseRefinement: the true poses
//   truth/view_000.depth.exr        distance along the ray, scene units
//   truth/view_000.normal.exr       unit normals, world axes
//   truth/view_000.albedo.exr       linear
// An earlier sample in the folder is replaced, and its remaining files are removed.
// Throws InputError if the options are out of range, the folder cannot be written, or it contains
// something that is not a sample (then nothing in it is changed).
void WriteSample(const std::filesystem::path& folder, const SampleOptions& options);

}  // namespace nerf::synthetic
