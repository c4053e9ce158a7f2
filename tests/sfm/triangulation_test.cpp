#include "sfm/triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/support/feature_scene.h"

namespace nerf::sfm {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Where the photographs of a scene see a point.
std::vector<TrackElement> TrackOf(const PosedImages& posed, const Vector3d& x) {
  std::vector<TrackElement> track;
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    const PosedImage& image = posed.images[i];
    const auto pixel =
        PixelFromPoint(posed.cameras[image.camera], image.world_from_camera.inverse() * x);
    if (pixel) track.push_back({static_cast<int>(i), *pixel});
  }
  return track;
}

class Triangulation : public testing::Test {
 protected:
  PosedImages posed_ = test::FeatureScene({.images = 6, .points = 1}).posed;
  const Vector3d x_ = Vector3d(0.3, -0.4, 0.5);
};

TEST_F(Triangulation, OfExactSightingsIsExact) {
  const auto point = Triangulate(posed_, TrackOf(posed_, x_));
  ASSERT_TRUE(point);
  EXPECT_LT((point->x_in_world - x_).norm(), 1e-8);
  EXPECT_LT(point->reprojection_error, 1e-6);
  EXPECT_EQ(point->track.size(), 6u);
}

// Every lens, for the rays and the errors go through it.
TEST_F(Triangulation, GoesThroughTheLens) {
  for (const Camera& camera : std::vector<Camera>{
           {CameraModel::kOpenCVFisheye, 640, 480, {400, 410, 320, 240, 0.02, -0.01, 0, 0}},
           {CameraModel::kSimpleRadial, 640, 480, {500, 320, 240, -0.1}},
           {CameraModel::kFov, 640, 480, {500, 500, 320, 240, 0.6}}}) {
    posed_.cameras = {camera};
    const auto point = Triangulate(posed_, TrackOf(posed_, x_));
    ASSERT_TRUE(point);
    EXPECT_LT((point->x_in_world - x_).norm(), 1e-7);
  }
}

// Of noise it is the least squares of the projections: no step to another point is better.
TEST_F(Triangulation, MinimizesTheProjectionErrors) {
  std::vector<TrackElement> track = TrackOf(posed_, x_);
  for (std::size_t i = 0; i < track.size(); ++i) {
    track[i].pixel += Vector2d(i % 2 == 0 ? 1.0 : -0.7, i % 3 == 0 ? 0.8 : -0.5);
  }
  const auto point = Triangulate(posed_, track);
  ASSERT_TRUE(point);
  const auto squares = [&](const Vector3d& x) {
    double sum = 0;
    for (const auto& [image, pixel] : track) {
      const PosedImage& of = posed_.images[image];
      sum +=
          (*PixelFromPoint(posed_.cameras[of.camera], of.world_from_camera.inverse() * x) - pixel)
              .squaredNorm();
    }
    return sum;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-4, 1e-4}) {
      EXPECT_GT(squares(point->x_in_world + step * Vector3d::Unit(axis)),
                squares(point->x_in_world));
    }
  }
  EXPECT_LT((point->x_in_world - x_).norm(), 0.02);
}

TEST_F(Triangulation, LeavesOutSightingsThatDisagree) {
  std::vector<TrackElement> track = TrackOf(posed_, x_);
  track[1].pixel += Vector2d(40, 10);
  track[4].pixel += Vector2d(-25, 60);
  const auto point = Triangulate(posed_, track);
  ASSERT_TRUE(point);
  EXPECT_LT((point->x_in_world - x_).norm(), 1e-8);
  ASSERT_EQ(point->track.size(), 4u);
  EXPECT_EQ(point->track[1].image, 2);
}

TEST_F(Triangulation, NeedsViewsAndAngles) {
  std::vector<TrackElement> track = TrackOf(posed_, x_);
  track.resize(2);
  EXPECT_FALSE(Triangulate(posed_, track));
  EXPECT_TRUE(Triangulate(posed_, track, {.min_views = 2}));
  EXPECT_FALSE(Triangulate(posed_, {}));
  // From nearly one place.
  const PosedImages narrow = test::FeatureScene({.images = 4, .points = 1, .arc = 0.005}).posed;
  EXPECT_FALSE(Triangulate(narrow, TrackOf(narrow, x_)));
  EXPECT_TRUE(Triangulate(narrow, TrackOf(narrow, x_), {.min_angle = 0.5}));
}

TEST_F(Triangulation, OfRandomSightingsIsNothing) {
  std::vector<TrackElement> track;
  for (int i = 0; i < 6; ++i) track.push_back({i, Vector2d(90 + 100 * i, 470 - 83 * i)});
  EXPECT_FALSE(Triangulate(posed_, track));
}

TEST(NearestToRays, IsBetweenThemAndInFront) {
  const auto x = NearestToRays({0, 0, 0}, {0, 0, 1}, {1, 0.2, 3}, {-1, 0, 0});
  ASSERT_TRUE(x);
  EXPECT_LT((*x - Vector3d(0, 0.1, 3)).norm(), 1e-12);
  EXPECT_FALSE(NearestToRays({0, 0, 0}, {0, 0, -1}, {1, 0, 3}, {-1, 0, 0}));
  EXPECT_FALSE(NearestToRays({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}));
}

}  // namespace
}  // namespace nerf::sfm
