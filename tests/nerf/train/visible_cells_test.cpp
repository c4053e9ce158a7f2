#include "nerf/train/visible_cells.h"

#include <gtest/gtest.h>

#include "nerf/sampling/contraction.h"
#include "nerf/scene/camera.h"
#include "tests/support/analytic_capture.h"

namespace nerf {
namespace {

constexpr int kResolution = 32;

OccupancyGrid Grid() {
  OccupancyOptions options;
  options.resolution = kResolution;
  return {options, 1.0f / 64};
}

View ViewFrom(const Camera& camera, const Eigen::Isometry3d& normalized_from_camera) {
  View view;
  view.camera = camera;
  view.normalized_from_camera = normalized_from_camera;
  return view;
}

// A camera at the origin that looks along +z, with a field of view of 40 degrees.
View Forward() {
  return ViewFrom(PinholeFromFov(64, 64, 40 * M_PI / 180), Eigen::Isometry3d::Identity());
}

bool IsKept(const OccupancyGrid& grid, const Eigen::Vector3f& x_in_normalized) {
  return grid.Occupied(UnitCubeFromContracted(Contract(x_in_normalized)));
}

// Culled cells can never become occupied, so every point that a pixel shows must be kept. Tested up
// to where cells are entirely in contracted space: of cells that its border cuts, those with their
// centre outside are emptied.
TEST(VisibleCells, EveryPointInAPictureIsKept) {
  std::vector<View> views;
  for (const Eigen::Isometry3d& pose : test::CameraRing(5, 2.0, 0.7)) {
    views.push_back(ViewFrom(PinholeFromFov(40, 30, 0.8), pose));
  }
  OccupancyGrid grid = Grid();
  KeepVisibleCells(grid, views);
  EXPECT_LT(grid.OccupiedFraction(), 1.0);
  for (const View& view : views) {
    for (int y = 0; y <= 30; y += 5) {
      for (int x = 0; x <= 40; x += 5) {
        const auto direction = DirectionFromPixel(view.camera, Eigen::Vector2d(x, y));
        ASSERT_TRUE(direction);
        for (const double t : {0.05, 0.5, 1.0, 2.0, 5.0, 8.0}) {
          const Eigen::Vector3d point = view.normalized_from_camera * (t * *direction);
          EXPECT_TRUE(IsKept(grid, point.cast<float>())) << x << " " << y << " t " << t;
        }
      }
    }
  }
}

TEST(VisibleCells, CellsOutsideAllFrustumsAreCulled) {
  OccupancyGrid grid = Grid();
  KeepVisibleCells(grid, {Forward()});
  for (const float distance : {0.6f, 1.0f, 3.0f}) {
    EXPECT_TRUE(IsKept(grid, {0, 0, distance})) << distance;
    EXPECT_FALSE(IsKept(grid, {0, 0, -distance})) << distance;  // behind the camera
    EXPECT_FALSE(IsKept(grid, {distance, 0, 0})) << distance;   // 90 degrees off its axis
  }
  // About the share of the sphere inside a field of view of 40 degrees, with a margin.
  EXPECT_LT(grid.OccupiedFraction(), 0.25);
}

TEST(VisibleCells, AreTheUnionOverViews) {
  OccupancyGrid one = Grid(), two = Grid();
  Eigen::Isometry3d backwards = Eigen::Isometry3d::Identity();
  backwards.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  KeepVisibleCells(one, {Forward()});
  KeepVisibleCells(two, {Forward(), ViewFrom(Forward().camera, backwards)});
  EXPECT_TRUE(IsKept(two, {0, 0, 1}));
  EXPECT_TRUE(IsKept(two, {0, 0, -1}));
  EXPECT_GT(two.OccupiedFraction(), one.OccupiedFraction());
  for (std::size_t cell = 0; cell < one.Density().size(); ++cell) {
    if (one.Density()[cell] >= 0) {
      EXPECT_GE(two.Density()[cell], 0) << cell;
    }
  }
}

// Where the lens model cannot be inverted at the border, nothing is culled by the angle.
TEST(VisibleCells, AreKeptWhereTheBorderIsOutsideTheFieldOfView) {
  View view = Forward();
  view.camera.model = CameraModel::kSimpleRadial;
  view.camera.params = {40, 32, 32, -0.9};
  ASSERT_FALSE(DirectionFromPixel(view.camera, Eigen::Vector2d(0, 0)));
  OccupancyGrid grid = Grid();
  KeepVisibleCells(grid, {view});
  EXPECT_TRUE(IsKept(grid, {0, 0, 1}));
  EXPECT_TRUE(IsKept(grid, {0.3f, 0.3f, 1}));
}

}  // namespace
}  // namespace nerf
