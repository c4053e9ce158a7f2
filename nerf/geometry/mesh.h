#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace nerf {

// Triangles, or points if there are no faces.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;  // of each vertex, unit, or 0: invalid; or none at all
  std::vector<std::array<std::uint8_t, 3>> colors;  // of each vertex, sRGB; or none at all
  std::vector<std::array<std::int32_t, 3>> faces;   // indices of vertices, counter-clockwise
};

}  // namespace nerf
