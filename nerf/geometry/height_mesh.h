#pragma once

#include <filesystem>

#include "nerf/image/image.h"

namespace nerf {

// Writes a height field as a mesh in PLY's binary format (Turk 1994), which MeshLab, Blender and
// the like read: a vertex for each pixel that has a height, two triangles between four of them.
//   height   1 channel, towards the camera, in pixels; NaN: no surface
//   color    3 channels of the same size, linear; stored as sRGB bytes a vertex
// Axes: x right, y up, z towards the camera; the middle of the picture is x = y = 0; unit pixel.
// The file appears whole or not at all. Throws InputError naming it.
void WriteHeightMesh(const std::filesystem::path& file, const Image& height, const Image& color);

}  // namespace nerf
