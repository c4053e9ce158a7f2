#include "nerf/scene/rigid_pose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

using nerf::test::InputErrorOf;
using testing::HasSubstr;

Eigen::Matrix4d SomePose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -3).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(4, -5, 6e5);
  return pose.matrix();
}

std::string ErrorOf(const Eigen::Matrix4d& matrix) {
  return InputErrorOf([&] { RigidFromMatrix(matrix, "file: frames[3]"); });
}

TEST(RigidPose, RigidMatrixIsKept) {
  EXPECT_TRUE(RigidFromMatrix(SomePose(), "").matrix().isApprox(SomePose(), 1e-15));
}

TEST(RigidPose, SlightlyInexactAxesBecomeTheNearestRotation) {
  Eigen::Matrix4d bent = SomePose();
  bent.topLeftCorner<3, 3>() *= 1.0003;
  bent(0, 1) += 1e-4;
  const Eigen::Matrix3d rotation = RigidFromMatrix(bent, "").linear();
  EXPECT_TRUE((rotation.transpose() * rotation).isIdentity(1e-14));
  EXPECT_NEAR(rotation.determinant(), 1, 1e-14);
  EXPECT_TRUE(rotation.isApprox(SomePose().topLeftCorner<3, 3>(), 2e-4));
}

TEST(RigidPose, OtherMatricesAreRefusedByName) {
  Eigen::Matrix4d matrix = SomePose();
  matrix(1, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ErrorOf(matrix), HasSubstr("file: frames[3]: an entry is not finite"));
  matrix = SomePose();
  matrix.topLeftCorner<3, 3>() *= 1.01;
  EXPECT_THAT(ErrorOf(matrix), HasSubstr("file: frames[3]: not a rigid motion"));
  matrix = SomePose();
  matrix.col(0) *= -1;
  EXPECT_THAT(ErrorOf(matrix), HasSubstr("mirrored"));
  matrix = SomePose();
  matrix(3, 0) = 0.5;
  EXPECT_THAT(ErrorOf(matrix), HasSubstr("last row"));
  EXPECT_THAT(ErrorOf(Eigen::Matrix4d::Zero()), HasSubstr("last row"));
  matrix = SomePose();
  matrix.topLeftCorner<3, 3>() *= 1e200;
  EXPECT_THAT(ErrorOf(matrix), HasSubstr("not a rigid motion"));
}

TEST(RigidPose, OpenGLCameraLooksAlongMinusZWithYUp) {
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d world_from_camera = WorldFromOpenCVCamera(identity);
  EXPECT_EQ(world_from_camera * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, -2, -3));
  const Eigen::Isometry3d pose(SomePose());
  EXPECT_EQ(WorldFromOpenGLCamera(WorldFromOpenCVCamera(pose)).matrix(), pose.matrix());
}

}  // namespace
}  // namespace nerf
