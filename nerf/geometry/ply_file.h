#pragma once

#include <filesystem>

#include "nerf/geometry/mesh.h"

namespace nerf {

// Writes a mesh as a binary little-endian PLY file (Turk 1994), which MeshLab and Blender read. The
// file is written whole or not at all.
// Throws InputError naming the file if it cannot be written, std::invalid_argument if the number of
// normals or colours is neither 0 nor that of the vertices, or if a face refers to no vertex.
void WritePly(const std::filesystem::path& file, const Mesh& mesh);

}  // namespace nerf
