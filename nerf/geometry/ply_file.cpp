#include "nerf/geometry/ply_file.h"

#include <spdlog/fmt/fmt.h>

#include <bit>
#include <stdexcept>
#include <string>

#include "nerf/base/atomic_file.h"

namespace nerf {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says little endian");

template <class T>
void Append(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

std::string Header(const Mesh& mesh) {
  std::string header = fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "element vertex {}\n"
      "property float x\n"
      "property float y\n"
      "property float z\n",
      mesh.vertices.size());
  if (!mesh.normals.empty()) {
    header +=
        "property float nx\n"
        "property float ny\n"
        "property float nz\n";
  }
  if (!mesh.colors.empty()) {
    header +=
        "property uchar red\n"
        "property uchar green\n"
        "property uchar blue\n";
  }
  return header + fmt::format(
                      "element face {}\n"
                      "property list uchar int vertex_indices\n"
                      "end_header\n",
                      mesh.faces.size());
}

void Check(const Mesh& mesh) {
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) {
    throw std::invalid_argument(
        fmt::format("{} normals for {} vertices", mesh.normals.size(), mesh.vertices.size()));
  }
  if (!mesh.colors.empty() && mesh.colors.size() != mesh.vertices.size()) {
    throw std::invalid_argument(
        fmt::format("{} colours for {} vertices", mesh.colors.size(), mesh.vertices.size()));
  }
  for (const auto& face : mesh.faces) {
    for (const std::int32_t corner : face) {
      if (corner >= 0 && static_cast<std::size_t>(corner) < mesh.vertices.size()) continue;
      throw std::invalid_argument(
          fmt::format("a face refers to vertex {} of {}", corner, mesh.vertices.size()));
    }
  }
}

}  // namespace

void WritePly(const std::filesystem::path& file, const Mesh& mesh) {
  Check(mesh);
  std::string bytes = Header(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Append(bytes, mesh.vertices[i].data(), 3);
    if (!mesh.normals.empty()) Append(bytes, mesh.normals[i].data(), 3);
    if (!mesh.colors.empty()) Append(bytes, mesh.colors[i].data(), 3);
  }
  for (const auto& face : mesh.faces) {
    bytes += '\3';  // corners
    Append(bytes, face.data(), 3);
  }
  WriteFileAtomically(file, bytes);
}

}  // namespace nerf
