#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "nerf/scene/camera.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {
namespace {

// At (1, 2, 3), looking along the world's x axis: camera z is x, camera x is -y, camera y is -z.
Eigen::Isometry3d LooksAlongX() {
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  world_from_camera.linear().col(0) = Eigen::Vector3d(0, -1, 0);
  world_from_camera.linear().col(1) = Eigen::Vector3d(0, 0, -1);
  world_from_camera.linear().col(2) = Eigen::Vector3d(1, 0, 0);
  world_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
  return world_from_camera;
}

// A pinhole of focal length 10 whose principal point is the centre of pixel (2, 1) of 5 x 4.
const Camera kPinhole = {CameraModel::kPinhole, 5, 4, {10, 10, 2.5, 1.5}};

TEST(RaysOfPixels, GoThroughPixelCentresInRowOrder) {
  const std::vector<std::int64_t> pixels = {7, 8, 12};  // (2, 1), (3, 1), (2, 2)
  const Eigen::Vector3f background(0.1f, 0.2f, 0.3f);
  const ViewRays rays = RaysOfPixels(kPinhole, LooksAlongX(), pixels, background);
  ASSERT_EQ(rays.rays.Size(), 3);
  EXPECT_EQ(rays.valid, (std::vector<std::uint8_t>{1, 1, 1}));
  const Eigen::Vector3d expected[] = {{1, 0, 0}, {1, -0.1, 0}, {1, 0, -0.1}};
  for (int r = 0; r < 3; ++r) {
    const Eigen::Vector3d direction = expected[r].normalized();
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(rays.rays.direction[3 * r + c], direction[c], 1e-6) << r;
      EXPECT_EQ(rays.rays.origin[3 * r + c], static_cast<float>(c + 1)) << r;
      EXPECT_EQ(rays.rays.background[3 * r + c], background[c]) << r;
    }
    EXPECT_EQ(rays.rays.jitter[r], 0.5f);
    // A pixel is 1/10 wide at depth 1, which is at distance 1/cos of the angle to the axis.
    EXPECT_NEAR(rays.rays.spread[r], 0.1 * direction.x(), 1e-6) << r;
  }
}

TEST(RaysOfPixels, OfADownscaledCameraAreThoseOfBlockCentres) {
  const Camera camera = {CameraModel::kPinhole, 7, 5, {10, 10, 3.5, 2.5}};
  const Camera small = Downscaled(camera, 2);
  ASSERT_EQ(small.width, 3);  // the last of 7 columns and of 5 rows fill no block
  ASSERT_EQ(small.height, 2);
  std::vector<std::int64_t> pixels(6);
  for (int i = 0; i < 6; ++i) pixels[i] = i;
  const auto pose = Eigen::Isometry3d::Identity();
  const ViewRays rays = RaysOfPixels(small, pose, pixels, Eigen::Vector3f::Zero());
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      const auto expected = DirectionFromPixel(camera, {2 * x + 1.0, 2 * y + 1.0});
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(rays.rays.direction[3 * (3 * y + x) + c], (*expected)[c], 1e-6);
      }
    }
  }
}

TEST(RaysOfPixels, AreInvalidOutsideTheImageCircleOfAFisheye) {
  // The circle has the radius 30 pi = 94; the image is 200 wide, so its left edge is outside.
  const Camera fisheye = {CameraModel::kOpenCVFisheye, 200, 2, {30, 30, 100, 1, 0, 0, 0, 0}};
  const std::vector<std::int64_t> pixels = {0, 100, 199};
  const ViewRays rays = RaysOfPixels(fisheye, LooksAlongX(), pixels, Eigen::Vector3f::Zero());
  EXPECT_EQ(rays.valid, (std::vector<std::uint8_t>{0, 1, 0}));
}

TEST(RaysOfPixels, OfNoPixelsAreNone) {
  const ViewRays rays = RaysOfPixels(kPinhole, LooksAlongX(), {}, Eigen::Vector3f::Zero());
  EXPECT_EQ(rays.rays.Size(), 0);
  EXPECT_TRUE(rays.valid.empty());
}

}  // namespace
}  // namespace nerf
