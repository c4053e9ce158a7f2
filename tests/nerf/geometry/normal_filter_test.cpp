#include "nerf/geometry/normal_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nerf/base/random.h"

namespace nerf {
namespace {

constexpr int kSide = 24;

// Two planes that meet at a right angle along the middle column, of which the normals are noisy.
Mesh NoisyEdge(double noise) {
  Mesh mesh;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const int from_edge = x - kSide / 2;
      mesh.vertices.emplace_back(from_edge < 0 ? from_edge : 0, y, from_edge < 0 ? 0 : from_edge);
      const Eigen::Vector3f normal =
          from_edge < 0 ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
      Eigen::Vector3f offset;
      for (int k = 0; k < 3; ++k) {
        offset[k] = RandomFloat(1, 2, static_cast<std::uint64_t>(3 * (y * kSide + x) + k)) - 0.5f;
      }
      mesh.normals.push_back((normal + static_cast<float>(noise) * offset).normalized());
    }
  }
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const int corner = y * kSide + x;
      mesh.faces.push_back({corner, corner + 1, corner + kSide});
      mesh.faces.push_back({corner + 1, corner + kSide + 1, corner + kSide});
    }
  }
  return mesh;
}

// Degrees, mean over the vertices.
double ErrorOf(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
    const int k = static_cast<int>(v % kSide) < kSide / 2 ? 2 : 0;
    sum += std::acos(std::min(1.0f, mesh.normals[v][k])) * 180 / std::numbers::pi;
  }
  return sum / static_cast<double>(mesh.normals.size());
}

TEST(NormalFilter, RemovesNoiseButKeepsAnEdge) {
  Mesh mesh = NoisyEdge(0.2);
  const double before = ErrorOf(mesh);
  FilterNormals(mesh, {});
  EXPECT_LT(ErrorOf(mesh), before / 3);
  for (const Eigen::Vector3f& normal : mesh.normals) EXPECT_NEAR(normal.norm(), 1, 1e-5);
}

TEST(NormalFilter, AWideAngleBlursTheEdge) {
  Mesh mesh = NoisyEdge(0);
  FilterNormals(mesh, {10, 180});
  EXPECT_GT(ErrorOf(mesh), 3);
}

TEST(NormalFilter, InvalidNormalsStayAndCountNothing) {
  Mesh mesh = NoisyEdge(0);
  mesh.normals[100].setZero();
  FilterNormals(mesh, {});
  EXPECT_TRUE(mesh.normals[100].isZero());
  EXPECT_LT((mesh.normals[101] - Eigen::Vector3f::UnitZ()).norm(), 1e-6f);
  Mesh none;
  FilterNormals(none, {});
  EXPECT_TRUE(none.normals.empty());
}

}  // namespace
}  // namespace nerf
