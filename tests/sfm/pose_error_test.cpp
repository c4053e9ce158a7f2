#include "sfm/pose_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/feature_scene.h"
#include "tests/support/input_error_of.h"

namespace nerf::sfm {
namespace {

class PoseError : public testing::Test {
 protected:
  PosedImages truth_ = test::FeatureScene({.images = 9, .points = 1}).posed;
  PosedImages found_ = truth_;
};

// Structure from motion knows neither frame nor unit.
TEST_F(PoseError, IsZeroForASimilarity) {
  const Eigen::Isometry3d moved = Eigen::Translation3d(3, -2, 5) *
                                  Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  for (PosedImage& image : found_.images) {
    image.world_from_camera = moved * image.world_from_camera;
    image.world_from_camera.translation() *= 7;
  }
  const PoseErrors errors = ComparePoses(found_, truth_);
  EXPECT_EQ(errors.images, 9);
  EXPECT_LT(errors.rotation_largest, 1e-6);
  EXPECT_LT(errors.position_largest, 1e-9);
}

TEST_F(PoseError, OfOnePhotographIsTheLargest) {
  found_.images[4].world_from_camera.rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()));
  const PoseErrors errors = ComparePoses(found_, truth_);
  EXPECT_NEAR(errors.rotation_largest, 0.05 * 180 / 3.14159, 0.4);
  EXPECT_LT(errors.rotation_median, 0.4);
  EXPECT_LT(errors.position_largest, 1e-9);
}

TEST_F(PoseError, NeedsFourCommonPhotographs) {
  found_.images.resize(3);
  EXPECT_THAT(test::InputErrorOf([&] { ComparePoses(found_, truth_); }),
              testing::HasSubstr("four or more"));
}

}  // namespace
}  // namespace nerf::sfm
