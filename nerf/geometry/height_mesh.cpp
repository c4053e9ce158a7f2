#include "nerf/geometry/height_mesh.h"

#include <spdlog/fmt/fmt.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/image/srgb.h"

namespace nerf {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says little endian");

template <class T>
void Append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace

void WriteHeightMesh(const std::filesystem::path& file, const Image& height, const Image& color) {
  std::string vertices;
  std::vector<std::int32_t> number(height.pixels.size(), -1);
  std::int32_t vertex_count = 0;
  for (int y = 0; y < height.height; ++y) {
    for (int x = 0; x < height.width; ++x) {
      const float z = *height.At(x, y);
      if (std::isnan(z)) continue;
      number[static_cast<std::size_t>(y) * height.width + x] = vertex_count++;
      Append(vertices, static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(height.width));
      Append(vertices, 0.5f * static_cast<float>(height.height) - static_cast<float>(y) - 0.5f);
      Append(vertices, z);
      for (int c = 0; c < 3; ++c) {
        Append(vertices, ByteFromSrgb(SrgbFromLinear(color.At(x, y)[c])));
      }
    }
  }
  std::string faces;
  std::int32_t face_count = 0;
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a < 0 || b < 0 || c < 0) return;
    Append(faces, std::uint8_t{3});
    for (const std::int32_t corner : {a, b, c}) Append(faces, corner);
    ++face_count;
  };
  for (int y = 0; y + 1 < height.height; ++y) {
    for (int x = 0; x + 1 < height.width; ++x) {
      const std::int32_t* above = &number[static_cast<std::size_t>(y) * height.width + x];
      const std::int32_t* below = above + height.width;
      add(above[0], below[0], below[1]);  // counter-clockwise as the camera sees them
      add(above[0], below[1], above[1]);
    }
  }
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement "
      "face {}\nproperty list uchar int vertex_indices\nend_header\n",
      vertex_count, face_count);
  WriteFileAtomically(file, header + vertices + faces);
}

}  // namespace nerf
