#pragma once

#include <filesystem>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// Where an LLFF folder keeps its photographs: images/, or else the images_N with the smallest N
// (copies reduced N times). Throws InputError when there is neither.
std::filesystem::path LlffImageFolder(const std::filesystem::path& folder);

// Reads poses_bounds.npy, [N,17] of float or double: per image a row-major 3x5 matrix, the axes of
// the camera (down, right, backwards), its centre, and height, width, focal length in pixels; then
// the nearest and farthest depth. Row i belongs to the i-th image by name. The lens is scaled to
// the images, its principal point in the middle; depth_range_in_world spans all images.
// Source: Mildenhall et al. 2019, LLFF, README "Using your own poses without running COLMAP".
// Throws InputError naming the file when it is no such array, when a pose is not rigid or a depth
// not positive, and when the numbers of images and poses differ.
PosedImages ReadLlff(const std::filesystem::path& folder);

}  // namespace nerf::sfm
