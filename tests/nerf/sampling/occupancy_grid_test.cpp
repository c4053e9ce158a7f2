#include "nerf/sampling/occupancy_grid.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace nerf {
namespace {

OccupancyOptions Options() {
  OccupancyOptions options;
  options.resolution = 16;
  options.warmup_steps = 0;
  return options;
}

// Matter in a small ball in the middle of the cube.
std::vector<float> DensityOfABall(std::span<const float> positions) {
  std::vector<float> density;
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    const Eigen::Vector3f x(positions[i], positions[i + 1], positions[i + 2]);
    density.push_back((x.array() - 0.5f).matrix().norm() < 0.2f ? 100.0f : 0.0f);
  }
  return density;
}

TEST(OccupancyGrid, StartsFull) {
  EXPECT_EQ(OccupancyGrid(Options(), 0.01f).OccupiedFraction(), 1.0);
}

TEST(OccupancyGrid, MarksMatterAndClearsTheRest) {
  OccupancyGrid grid(Options(), 0.01f);
  for (int step = 0; step < 60; ++step) grid.Update(step, 7, DensityOfABall);
  EXPECT_TRUE(grid.Occupied({0.5f, 0.5f, 0.5f}));
  EXPECT_FALSE(grid.Occupied({0.1f, 0.5f, 0.5f}));
  // The ball and the cells that it touches: between its volume and that of a ball a cell larger.
  EXPECT_GT(grid.OccupiedFraction(), 0.03);
  EXPECT_LT(grid.OccupiedFraction(), 0.09);
}

TEST(OccupancyGrid, MarksMatterThatAppearsLater) {
  OccupancyGrid grid(Options(), 0.01f);
  const auto nothing = [](std::span<const float> p) {
    return std::vector<float>(p.size() / 3, 0.0f);
  };
  for (int step = 0; step < 20; ++step) grid.Update(step, 7, nothing);
  for (int step = 20; step < 80; ++step) grid.Update(step, 7, DensityOfABall);
  EXPECT_TRUE(grid.Occupied({0.5f, 0.5f, 0.5f}));
}

TEST(OccupancyGrid, CellsThatNoCameraSeesStayEmpty) {
  OccupancyGrid grid(Options(), 0.01f);
  grid.KeepVisible([](const Eigen::Vector3f& centre, float) { return centre[0] < 0.5f; });
  for (int step = 0; step < 40; ++step) {
    grid.Update(step, 7,
                [](std::span<const float> p) { return std::vector<float>(p.size() / 3, 100.0f); });
  }
  EXPECT_TRUE(grid.Occupied({0.4f, 0.5f, 0.5f}));
  EXPECT_FALSE(grid.Occupied({0.6f, 0.5f, 0.5f}));
}

TEST(OccupancyGrid, IsEmptyOutsideTheCube) {
  const OccupancyGrid grid(Options(), 0.01f);
  EXPECT_FALSE(grid.Occupied({-0.01f, 0.5f, 0.5f}));
  EXPECT_FALSE(grid.Occupied({0.5f, 1.01f, 0.5f}));
  EXPECT_FALSE(grid.Occupied({NAN, 0.5f, 0.5f}));
  EXPECT_TRUE(grid.Occupied({1.0f, 1.0f, 1.0f}));  // the far corner belongs to the last cell
}

TEST(OccupancyGrid, IsRestoredFromItsDensities) {
  OccupancyGrid grid(Options(), 0.01f), copy(Options(), 0.01f);
  for (int step = 0; step < 30; ++step) grid.Update(step, 7, DensityOfABall);
  copy.Density() = grid.Density();
  copy.Refresh();
  EXPECT_EQ(copy.OccupiedFraction(), grid.OccupiedFraction());
}

}  // namespace
}  // namespace nerf
