#include "nerf/scene/depth_fusion.h"

#include <gtest/gtest.h>

#include <numbers>

#include "nerf/geometry/directions.h"
#include "nerf/geometry/level_set_mesh.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr double kRadius = 0.5;

// A camera that looks at the origin, and what it sees of a sphere there.
DepthMap SphereFrom(const Eigen::Vector3d& position) {
  DepthMap view;
  view.camera = PinholeFromFov(80, 64, 0.6);
  const Eigen::Vector3d z = -position.normalized();
  const Eigen::Vector3d x = z.unitOrthogonal(), y = z.cross(x);
  view.grid_from_camera.setIdentity();
  view.grid_from_camera.linear() << x, y, z;
  view.grid_from_camera.translation() = position;
  view.distance = view.opacity = Image(80, 64, 1);
  for (int v = 0; v < 64; ++v) {
    for (int u = 0; u < 80; ++u) {
      const auto direction = DirectionFromPixel(view.camera, {u + 0.5, v + 0.5});
      const double along = direction->z() * position.norm();
      const double under = along * along - position.squaredNorm() + kRadius * kRadius;
      if (under < 0) continue;
      *view.opacity.At(u, v) = 1;
      *view.distance.At(u, v) = static_cast<float>(along - std::sqrt(under));
    }
  }
  return view;
}

std::vector<DepthMap> ViewsAround(int count) {
  std::vector<DepthMap> views;
  for (int i = 0; i < count; ++i) views.push_back(SphereFrom(3 * FibonacciDirection(i, count)));
  return views;
}

FusionBox Box() {
  FusionBox where;
  where.box = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-0.8), Eigen::Vector3d::Constant(0.8));
  where.cell = 0.04;
  return where;
}

TEST(FuseDepth, ViewsOfASphereGiveItsSurface) {
  const Mesh mesh = LevelSetMesh(FuseDepth(ViewsAround(60), Box()), 0);
  ASSERT_GT(mesh.vertices.size(), 500u);
  double off = 0, turned = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d at = mesh.vertices[i].cast<double>();
    EXPECT_NEAR(at.norm(), kRadius, 0.02);
    off += at.norm() - kRadius;
    turned += std::acos(std::min(1.0, mesh.normals[i].cast<double>().dot(at.normalized())));
  }
  const auto count = static_cast<double>(mesh.vertices.size());
  EXPECT_NEAR(off / count, 0, 0.005);
  EXPECT_LT(turned / count * 180 / std::numbers::pi, 3);
}

TEST(FuseDepth, FollowsTheFirstSurfaceAndNotWhatIsBehind) {
  const ScalarGrid grid = FuseDepth({SphereFrom({0, 0, -3})}, Box());
  EXPECT_NEAR(grid.At({0, 0, -0.56}), 0.5, 0.05);  // 1.5 of 3 cells before the surface
  EXPECT_NEAR(grid.At({0, 0, -0.44}), -0.5, 0.05);
  EXPECT_EQ(grid.At({0, 0, 0}), -1);  // nobody knows
  EXPECT_EQ(grid.At({0, 0, 0.7}), -1);
  EXPECT_EQ(grid.At({0.75, 0, 0}), 1);  // seen through
}

TEST(FuseDepth, WithoutViewsNothingIsKnown) {
  const ScalarGrid grid = FuseDepth({}, Box());
  EXPECT_TRUE(std::ranges::all_of(grid.values, [](float v) { return v == -1; }));
}

}  // namespace
}  // namespace nerf
