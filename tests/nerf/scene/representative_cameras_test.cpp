#include "nerf/scene/representative_cameras.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace nerf {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Eigen::Isometry3d At(double x, double y, double turned = 0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, 0);
  pose.rotate(Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitY()));
  return pose;
}

TEST(RepresentativeCameras, AreOneOfEachGroup) {
  std::vector<Eigen::Isometry3d> cameras;
  for (const double group : {0.0, 10.0, 20.0}) {
    for (const double offset : {-1.0, 0.0, 1.0}) cameras.push_back(At(group, offset));
  }
  const auto chosen = RepresentativeCameras(cameras, 3);
  ASSERT_EQ(chosen.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(chosen[k] / 3, k);
}

TEST(RepresentativeCameras, OfOnePositionDifferInDirection) {
  std::vector<Eigen::Isometry3d> cameras;
  for (const double group : {0.0, 1.5}) {
    for (const double offset : {-0.1, 0.0, 0.1}) cameras.push_back(At(0, 0, group + offset));
  }
  const auto chosen = RepresentativeCameras(cameras, 2);
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_LT(chosen[0], 3u);
  EXPECT_GE(chosen[1], 3u);
}

// Swaps mend the first choice, which is the middle one of all.
TEST(RepresentativeCameras, OfTwoGroupsOfDifferentSizesAreOneInEach) {
  std::vector<Eigen::Isometry3d> cameras;
  for (int i = 0; i < 30; ++i) cameras.push_back(At(0.01 * i, 0));
  for (int i = 0; i < 5; ++i) cameras.push_back(At(50, 0.01 * i));
  const auto chosen = RepresentativeCameras(cameras, 2);
  ASSERT_EQ(chosen.size(), 2u);
  // In the group of thirty neither the middle one nor the last.
  EXPECT_NEAR(std::abs(static_cast<double>(chosen[0]) - 14.5), 7, 1.5);
  EXPECT_GE(chosen[1], 30u);
}

TEST(RepresentativeCameras, MayBeAllOrNone) {
  const std::vector<Eigen::Isometry3d> cameras = {At(0, 0), At(1, 0), At(5, 0), At(9, 2)};
  EXPECT_THAT(RepresentativeCameras(cameras, 4), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(RepresentativeCameras(cameras, 0), IsEmpty());
  EXPECT_THAT(RepresentativeCameras({}, 0), IsEmpty());
}

}  // namespace
}  // namespace nerf
