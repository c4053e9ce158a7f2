#pragma once

#include <filesystem>

#include "nerf/capture/photometric_maps.h"

namespace nerf {

// Writes the results of photometric stereo into a folder, which is created if it does not exist.
// Each map is written as a picture and as values:
//   normals.png, normals.exr    (n + 1) / 2; unit vectors, x right, y up, z towards the camera
//   albedo.png, albedo.exr      sRGB, the brightest 2 % clipped; linear
//   residual.png, residual.exr  black 0 to white 10 %; relative to the albedo
//   depth.ply                   the integrated normals as a mesh, coloured by the albedo; reduced
//                               if there are more than kMaxHeightPixels pixels
//   relit.png                   under a new light from the upper left
// Throws InputError if a file cannot be written.
void WritePhotometricFolder(const std::filesystem::path& folder, const PhotometricMaps& maps);

}  // namespace nerf
