#pragma once

#include <filesystem>

#include "nerf/appearance/photometric_maps.h"

namespace nerf::appearance {

// Writes what photometric stereo found into a folder, which is made where it does not exist:
//   normals.png, normals.exr     (n + 1) / 2 to look at; unit vectors, x right, y up, z to the
//   camera albedo.png, albedo.exr       as sRGB to look at, brightest 2 % cut off; linear
//   residual.png, residual.exr   black 0 to white 10 %; relative to the albedo
//   depth.ply                    the integrated normals as a mesh with the albedo as colours; of
//   more than
//                                kMostPixels pixels in blocks of them
//   relit.png                    under a light that was not there, from the upper left
// Throws sfm::InputError where a file cannot be written.
void WritePhotometricFolder(const std::filesystem::path& folder, const PhotometricMaps& maps);

}  // namespace nerf::appearance
