#include "nerf/geometry/ply_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "nerf/geometry/height_mesh.h"
#include "nerf/image/srgb.h"
#include "tests/support/input_error_of.h"
#include "tests/support/ply_reader.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

Mesh Tetrahedron() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1.5f, 0}, {0, 0, -1e-9f}};
  mesh.colors = {{0, 127, 255}, {1, 2, 3}, {10, 13, 26}, {255, 255, 255}};
  mesh.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

void ExpectSame(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.faces, b.faces);
}

TEST(WritePly, IsReadBackUnchanged) {
  const test::ScratchFolder scratch;
  Mesh mesh = Tetrahedron();
  WritePly(scratch.path() / "a.ply", mesh);
  ExpectSame(test::ReadPly(scratch.path() / "a.ply"), mesh);
  mesh.colors.clear();
  WritePly(scratch.path() / "a.ply", mesh);
  ExpectSame(test::ReadPly(scratch.path() / "a.ply"), mesh);
  mesh.faces.clear();
  WritePly(scratch.path() / "a.ply", mesh);
  ExpectSame(test::ReadPly(scratch.path() / "a.ply"), mesh);
  WritePly(scratch.path() / "a.ply", {});
  ExpectSame(test::ReadPly(scratch.path() / "a.ply"), {});
}

TEST(WritePly, RejectsInconsistentMeshesAndWritesNothing) {
  const test::ScratchFolder scratch;
  Mesh mesh = Tetrahedron();
  mesh.colors.pop_back();
  EXPECT_THROW(WritePly(scratch.path() / "a.ply", mesh), std::invalid_argument);
  for (const int corner : {-1, 4}) {
    mesh = Tetrahedron();
    mesh.faces[2][1] = corner;
    EXPECT_THROW(WritePly(scratch.path() / "a.ply", mesh), std::invalid_argument);
  }
  EXPECT_FALSE(std::filesystem::exists(scratch.path() / "a.ply"));
}

TEST(WritePly, NamesAFileThatCannotBeWritten) {
  EXPECT_THAT(test::InputErrorOf([] { WritePly("/nowhere/a.ply", Tetrahedron()); }),
              testing::HasSubstr("/nowhere/a.ply"));
}

TEST(HeightMesh, HasAVertexForEachHeightAndTrianglesThatFaceTheCamera) {
  Image height(3, 2, 1, ColorEncoding::kLinear);
  Image color(3, 2, 3, ColorEncoding::kLinear);
  *height.At(1, 0) = 4;
  color.At(1, 0)[2] = LinearFromSrgb(0.4f);
  *height.At(2, 1) = std::nanf("");
  const Mesh mesh = MeshFromHeights(height, color);
  ASSERT_EQ(mesh.vertices.size(), 5u);
  ASSERT_EQ(mesh.faces.size(), 2u);
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3f(-1, 0.5f, 0));
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3f(0, 0.5f, 4));
  EXPECT_EQ(mesh.vertices[4], Eigen::Vector3f(0, -0.5f, 0));
  EXPECT_EQ(mesh.colors[1], (std::array<std::uint8_t, 3>{0, 0, 102}));
  for (const auto& [a, b, c] : mesh.faces) {
    const Eigen::Vector3f corner = mesh.vertices[a];
    EXPECT_GT((mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).z(), 0);
  }
}

}  // namespace
}  // namespace nerf
