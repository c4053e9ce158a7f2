#pragma once

#include <filesystem>

#include "nerf/image/image.h"

namespace nerf {

// Reads a map of true normals: 3 channels, unit length; 0 where there is none (shorter than a half
// or longer than 1.5). x right, y up, z towards the camera.
//   .mat    MATLAB: the variable Normal_gt, or the only one of height x width x 3 (DiLiGenT)
//   .exr    components, also of other float formats
//   .png    (n + 1) / 2, also of other integer formats
// Throws InputError naming the file.
Image ReadNormalTruth(const std::filesystem::path& file);

// The angle between normals and true ones, degrees.
struct NormalError {
  double mean = 0, median = 0;
  int pixels = 0;  // that have both
};
// Throws InputError naming the file of the truth if the sizes differ, or no pixel has both.
NormalError CompareNormals(const Image& normal, const Image& truth,
                           const std::filesystem::path& truth_file);

}  // namespace nerf
