#pragma once

#include <filesystem>

#include "nerf/capture/photometric_maps.h"

namespace nerf {

// Writes what photometric stereo found into a folder, which is made where it does not exist; of
// each map one file to look at and one of measurements:
//   normals.png, normals.exr    (n + 1) / 2; unit vectors, x right, y up, z to the camera
//   albedo.png, albedo.exr      as sRGB, the brightest 2 % cut off; linear
//   residual.png, residual.exr  black 0 to white 10 %; relative to the albedo
//   depth.ply                   the integrated normals as a mesh with the albedo as colours, in
//                               blocks of pixels where there are more than kMostPixels
//   relit.png                   under a light that was not there, from the upper left
// Throws InputError where a file cannot be written.
void WritePhotometricFolder(const std::filesystem::path& folder, const PhotometricMaps& maps);

}  // namespace nerf
