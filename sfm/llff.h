#pragma once

#include <filesystem>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// The folder of photographs in an LLFF folder: images/, or else the images_N with the smallest N
// (copies downscaled by N). Throws InputError when there is neither.
std::filesystem::path LlffImageFolder(const std::filesystem::path& folder);

// Reads poses_bounds.npy, [N,17] of float or double: per image a row-major 3x5 matrix (the axes of
// the camera: down, right, backwards; its centre; height, width and focal length in pixels), then
// the nearest and farthest depth. Row i belongs to the i-th image by name. The lens is scaled to
// the images, its principal point in the image centre; depth_range_in_world spans all images.
// Source: Mildenhall et al. 2019, LLFF, README "Using your own poses without running COLMAP".
// Throws InputError naming the file when it is no such array, when a pose is not rigid or a depth
// not positive, and when the numbers of images and poses differ.
PosedImages ReadLlff(const std::filesystem::path& folder);

}  // namespace nerf::sfm
