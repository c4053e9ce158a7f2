#include "nerf/geometry/height_mesh.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "nerf/image/srgb.h"

namespace nerf {

Mesh MeshFromHeights(const Image& height, const Image& color) {
  Mesh mesh;
  std::vector<std::int32_t> number(height.pixels.size(), -1);
  for (int y = 0; y < height.height; ++y) {
    for (int x = 0; x < height.width; ++x) {
      const float z = *height.At(x, y);
      if (std::isnan(z)) continue;
      number[static_cast<std::size_t>(y) * height.width + x] =
          static_cast<std::int32_t>(mesh.vertices.size());
      mesh.vertices.emplace_back(
          static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(height.width),
          0.5f * static_cast<float>(height.height) - static_cast<float>(y) - 0.5f, z);
      const float* rgb = color.At(x, y);
      mesh.colors.push_back({ByteFromSrgb(SrgbFromLinear(rgb[0])),
                             ByteFromSrgb(SrgbFromLinear(rgb[1])),
                             ByteFromSrgb(SrgbFromLinear(rgb[2]))});
    }
  }
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a >= 0 && b >= 0 && c >= 0) mesh.faces.push_back({a, b, c});
  };
  for (int y = 0; y + 1 < height.height; ++y) {
    for (int x = 0; x + 1 < height.width; ++x) {
      const std::int32_t* above = &number[static_cast<std::size_t>(y) * height.width + x];
      const std::int32_t* below = above + height.width;
      add(above[0], below[0], below[1]);  // counter-clockwise as the camera sees them
      add(above[0], below[1], above[1]);
    }
  }
  return mesh;
}

}  // namespace nerf
