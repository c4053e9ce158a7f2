#include "nerf/scene/camera_intrinsics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

using nerf::test::InputErrorOf;
using testing::HasSubstr;

const Camera kPortrait = {CameraModel::kPinhole, 30, 40, {50, 60, 14, 21}};

TEST(CameraIntrinsics, FocalLengthAndPrincipalPointAreTakenByModel) {
  const Camera radial = {CameraModel::kRadial, 30, 40, {50, 14, 21, 0.1, 0.2}};
  EXPECT_EQ(FocalLengths(radial), Eigen::Vector2d(50, 50));
  EXPECT_EQ(PrincipalPoint(radial), Eigen::Vector2d(14, 21));
  EXPECT_EQ(FocalLengths(kPortrait), Eigen::Vector2d(50, 60));
  EXPECT_EQ(PrincipalPoint(kPortrait), Eigen::Vector2d(14, 21));
}

TEST(CameraIntrinsics, StoredSizeDecidesBeforeExif) {
  EXPECT_EQ(UprightByExif(kPortrait, {30, 40, 6}), false);
  EXPECT_EQ(UprightByExif(kPortrait, {40, 30, 6}), true);
  EXPECT_EQ(UprightByExif(kPortrait, {40, 30, 3}), std::nullopt);
  EXPECT_EQ(UprightByExif(kPortrait, {60, 80, 1}), std::nullopt);
}

TEST(CameraIntrinsics, LensIsScaledToACopyOfTheImage) {
  const auto half = FitToImage(kPortrait, {15, 20, 1});
  ASSERT_TRUE(half);
  EXPECT_FALSE(half->upright_by_exif);
  EXPECT_EQ(half->camera, (Camera{CameraModel::kPinhole, 15, 20, {25, 30, 7, 10.5}}));
  const auto turned = FitToImage(kPortrait, {80, 60, 8});
  ASSERT_TRUE(turned);
  EXPECT_TRUE(turned->upright_by_exif);
  EXPECT_EQ(turned->camera.params, (std::vector<double>{100, 120, 28, 42}));
}

TEST(CameraIntrinsics, SizesReducedByAnIntegerFactorMayBeTruncatedOrRounded) {
  const Camera odd = {CameraModel::kSimplePinhole, 1079, 719, {1000, 540, 360}};
  EXPECT_TRUE(FitToImage(odd, {539, 359, 1}));
  EXPECT_TRUE(FitToImage(odd, {540, 360, 1}));
  EXPECT_TRUE(FitToImage(odd, {538, 359, 1}));    // 538 wide
  EXPECT_TRUE(FitToImage(odd, {1600, 1066, 1}));  // enlarged
  EXPECT_FALSE(FitToImage(odd, {538, 361, 1}));
  EXPECT_FALSE(FitToImage(odd, {520, 359, 1}));
  EXPECT_FALSE(FitToImage(odd, {1078, 719, 1}));
}

TEST(CameraIntrinsics, InvalidCamerasAreRefusedByName) {
  const auto error_of = [](Camera camera) {
    return InputErrorOf([&] { CheckCamera(camera, "cameras.txt: camera 7"); });
  };
  EXPECT_EQ(error_of(kPortrait), "no error");
  Camera camera = kPortrait;
  camera.width = 0;
  EXPECT_THAT(error_of(camera), HasSubstr("cameras.txt: camera 7: the image size 0x40"));
  camera = kPortrait;
  camera.params.pop_back();
  EXPECT_THAT(error_of(camera), HasSubstr("has 4 parameters, not 3"));
  camera = kPortrait;
  camera.params[2] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(error_of(camera), HasSubstr("not finite"));
  camera = kPortrait;
  camera.params[1] = -1;
  EXPECT_THAT(error_of(camera), HasSubstr("focal length -1 is not positive"));
}

}  // namespace
}  // namespace nerf
