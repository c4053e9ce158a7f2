#pragma once

#include <filesystem>

#include "nerf/synthetic/sample_options.h"

namespace nerf::synthetic {

// Photographs the scene of options.occasion into a folder, which is made where it does not exist:
//   images/view_000.png, ...        photographs, 8-bit sRGB (or .exr, radiance), all that structure
//                                   from motion and training may see
//   masks/view_000.png              where the occasion is masks
//   truth/transforms.json           poses, pointing at ../images: true ones, but where the occasion
//                                   is poses
//   truth/sparse/                   the same as a COLMAP model, with points and who sees them
//   truth/poses.json                true poses, where those of transforms.json are not
//   truth/view_000.depth.exr        distance along the ray, scene units
//   truth/view_000.normal.exr       unit normals, world axes
//   truth/view_000.albedo.exr       linear
// An earlier sample in the folder is replaced, file by file, and what it had more of is removed.
// Throws InputError where the options are out of range, the folder cannot be written, or it
// holds something that is not a sample (nothing in it is touched then).
void WriteSample(const std::filesystem::path& folder, const SampleOptions& options);

}  // namespace nerf::synthetic
