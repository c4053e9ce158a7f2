#include "nerf/geometry/level_set_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "nerf/geometry/mesh_rays.h"

namespace nerf {
namespace {

constexpr double kRadius = 0.7;
const Eigen::Vector3d kCentre(0.1, -0.05, 0.02);

// The signed distance to a sphere.
ScalarGrid SphereGrid(double cell) {
  ScalarGrid grid;
  grid.cell = cell;
  grid.origin = Eigen::Vector3d(-1, -1.1, -1.05);
  grid.size = Eigen::Vector3i::Constant(static_cast<int>(2.2 / cell) + 1);
  for (int z = 0; z < grid.size.z(); ++z) {
    for (int y = 0; y < grid.size.y(); ++y) {
      for (int x = 0; x < grid.size.x(); ++x) {
        grid.values.push_back(
            static_cast<float>((grid.PositionOf(x, y, z) - kCentre).norm() - kRadius));
      }
    }
  }
  return grid;
}

TEST(ScalarGrid, IsTrilinearAndGoesOnAtItsBorder) {
  ScalarGrid grid;
  grid.size = {3, 2, 2};
  grid.origin = {1, 2, 3};
  grid.cell = 0.5;
  const auto linear = [](const Eigen::Vector3d& p) { return 2 * p.x() - p.y() + 3 * p.z() + 1; };
  for (int z = 0; z < 2; ++z) {
    for (int y = 0; y < 2; ++y) {
      for (int x = 0; x < 3; ++x) {
        grid.values.push_back(static_cast<float>(linear(grid.PositionOf(x, y, z))));
      }
    }
  }
  const Eigen::Vector3d inside(1.7, 2.2, 3.4);
  EXPECT_NEAR(grid.At(inside), linear(inside), 1e-5);
  EXPECT_NEAR(grid.At({-5, 2.2, 3.4}), linear({1, 2.2, 3.4}), 1e-5);
  EXPECT_NEAR(grid.At({9, 9, 9}), linear({2, 2.5, 3.5}), 1e-5);
}

TEST(ScalarGrid, BlurKeepsTheMeanAndFlattens) {
  ScalarGrid grid;
  grid.size = {21, 21, 21};
  grid.values.assign(21 * 21 * 21, 0.0f);
  grid.values[grid.Index(10, 10, 10)] = 1;
  Blur(grid, 1.5);
  double sum = 0;
  for (const float value : grid.values) sum += static_cast<double>(value);
  EXPECT_NEAR(sum, 1, 1e-4);
  // The peak of a Gaussian in three dimensions.
  EXPECT_NEAR(grid.values[grid.Index(10, 10, 10)], std::pow(2 * M_PI * 1.5 * 1.5, -1.5), 1e-3);
  const std::vector<float> before = grid.values;
  Blur(grid, 0);
  EXPECT_EQ(grid.values, before);
}

TEST(LevelSetMesh, SphereIsClosedRoundAndFacesOutwards) {
  const Mesh mesh = LevelSetMesh(SphereGrid(0.05), 0);
  ASSERT_GT(mesh.faces.size(), 1000u);
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d from_centre = mesh.vertices[i].cast<double>() - kCentre;
    EXPECT_NEAR(from_centre.norm(), kRadius, 2e-3);
    EXPECT_GT(mesh.normals[i].cast<double>().dot(from_centre.normalized()), 0.999);
  }
  double volume = 0;
  std::map<std::pair<int, int>, int> edges;  // each one once in each direction
  for (const auto& face : mesh.faces) {
    volume += static_cast<double>(mesh.vertices[face[0]].dot(
                  mesh.vertices[face[1]].cross(mesh.vertices[face[2]]))) /
              6;
    for (int k = 0; k < 3; ++k) ++edges[{face[k], face[(k + 1) % 3]}];
  }
  EXPECT_NEAR(volume, 4 * M_PI / 3 * std::pow(kRadius, 3), 0.01);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
}

TEST(LevelSetMesh, OfALevelThatIsNowhereIsEmpty) {
  const Mesh mesh = LevelSetMesh(SphereGrid(0.1), -5);
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.faces.empty());
  EXPECT_FALSE(MeshRays(mesh).FirstHit({0, 0, -3}, {0, 0, 1}));
}

TEST(MeshRays, MeetTheSphereWhereItIs) {
  const Mesh mesh = LevelSetMesh(SphereGrid(0.04), 0);
  const MeshRays rays(mesh);
  const Eigen::Vector3f centre = kCentre.cast<float>();
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3f direction = Eigen::Vector3f::Random().normalized();
    const Eigen::Vector3f aside = 0.6f * Eigen::Vector3f::Random().cross(direction);
    const Eigen::Vector3f origin = centre - 3 * direction + aside;
    const auto hit = rays.FirstHit(origin, direction);
    const float h2 = static_cast<float>(kRadius * kRadius) -
                     (aside - direction * direction.dot(aside)).squaredNorm();
    if (std::abs(h2) < 0.05f) continue;  // grazing
    ASSERT_EQ(hit.has_value(), h2 > 0);
    EXPECT_EQ(rays.IsBlocked(origin, direction), h2 > 0);
    if (!hit) continue;
    EXPECT_NEAR(hit->distance, 3 - direction.dot(aside) - std::sqrt(h2), 0.01);
    EXPECT_TRUE(hit->is_front);
    EXPECT_NEAR(hit->barycentric.sum(), 1, 1e-5);
    Eigen::Vector3f at = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) at += hit->barycentric[k] * mesh.vertices[mesh.faces[hit->face][k]];
    EXPECT_LT((at - (origin + hit->distance * direction)).norm(), 1e-4f);
    // From within, the other side.
    const auto leaving = rays.FirstHit(origin, direction, hit->distance + 0.05f);
    ASSERT_TRUE(leaving);
    EXPECT_FALSE(leaving->is_front);
    EXPECT_FALSE(rays.IsBlocked(origin, direction, leaving->distance + 0.05f));
  }
}

}  // namespace
}  // namespace nerf
