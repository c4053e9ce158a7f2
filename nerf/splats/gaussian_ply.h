#pragma once

#include <cstdint>
#include <filesystem>

#include "nerf/scene/scene_normalization.h"
#include "nerf/splats/gaussian_cloud.h"

namespace nerf {

// Gaussians as the reference implementation of 3D Gaussian Splatting writes them, which viewers
// read: a binary PLY file, in the frame and units of the input. For each Gaussian x, y, z; nx, ny,
// nz (0); f_dc_*, f_rest_* (harmonics, those of a channel together); opacity before the sigmoid;
// scale_* (logarithms); rot_* (w, x, y, z). Source: graphdeco-inria/gaussian-splatting,
// scene/gaussian_model.py, save_ply.
//
// The harmonics are turned into the frame of the input. Throws InputError naming the file if it
// cannot be written.
void WriteGaussianPly(const std::filesystem::path& file, const GaussianCloud& cloud,
                      const SceneNormalization& normalized_from_world);

// Bytes of a Gaussian in the file.
std::int64_t BytesInPly(int harmonics_order);

struct GaussianPly {
  GaussianCloud cloud;        // in the frame and units of the file
  std::int64_t left_out = 0;  // Gaussians with a value that is not finite
};

// Reads what WriteGaussianPly and other tools write: properties of any order and type, harmonics of
// order 0 to 3. Throws InputError naming the file, and what is missing or damaged.
GaussianPly ReadGaussianPly(const std::filesystem::path& file);

}  // namespace nerf
