#include "nerf/pipeline/surface_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/pipeline/gaussian_scene.h"
#include "tests/support/ball_model.h"

namespace nerf {
namespace {

using test::BallModel;
using test::CaptureOfBall;
using test::kBallRadius;

SurfacePoints PointsOf(const BallModel& model, std::int64_t wanted = 4000) {
  const test::AnalyticCapture capture = CaptureOfBall();
  return *FindSurfacePoints(model, TargetViewsOf(capture.data.train), wanted, false,
                            [](std::size_t) {});
}

TEST(SurfacePoints, AreOnTheSurface) {
  const SurfacePoints found = PointsOf(BallModel(true));
  EXPECT_GT(found.points.size(), 2000u);
  EXPECT_LE(found.points.size(), 4000u);
  for (const ColoredPoint& point : found.points) {
    EXPECT_NEAR(point.x_in_normalized.norm(), kBallRadius, 1e-4);
    EXPECT_EQ(point.rgb, Eigen::Vector3f(0.7f, 0, 0));
  }
  EXPECT_NEAR(found.nearest, std::hypot(4, 1) - kBallRadius, 0.2);
}

TEST(SurfacePoints, WithoutASurfaceAreASky) {
  const SurfacePoints found = PointsOf(BallModel(false));
  std::size_t far = 0;
  for (const ColoredPoint& point : found.points) {
    if (point.x_in_normalized.norm() < 1) continue;
    ++far;
    EXPECT_GT(point.x_in_normalized.norm(), 100);
    EXPECT_EQ(point.rgb, Eigen::Vector3f(0, 0, 0.7f));
  }
  EXPECT_GT(far, 500u);
  EXPECT_GT(found.points.size() - far, 500u);
  EXPECT_LE(found.points.size(), 4000u);
}

TEST(SurfacePoints, OfASkyAloneAreNone) {
  EXPECT_TRUE(PointsOf(BallModel(false, 0)).points.empty());
}

// The field shows nothing yet, but photographs have alpha.
TEST(StartAtSurfaces, BeginsAtTheVisualHullWithoutSurfaces) {
  const test::AnalyticCapture capture = CaptureOfBall();
  GaussianScene scene;
  scene.config.splats.count = 2000;
  scene.facts.has_alpha = true;
  scene.train = TargetViewsOf(capture.data.train);
  const auto start = StartAtSurfaces(BallModel(true, 0), scene, false, [](std::size_t) {});
  int visible = 0;
  for (std::int64_t i = 0; i < start->state.cloud.count; ++i) {
    if (start->state.cloud.At(i, kernels::kOpacityRow) < 0) continue;
    ++visible;
    Eigen::Vector3d mean;
    for (int k = 0; k < 3; ++k) mean[k] = start->state.cloud.At(i, kernels::kMeanRow + k);
    EXPECT_GT(mean.norm(), kBallRadius - 0.1);
    EXPECT_LT(mean.norm(), kBallRadius + 0.3);  // no camera looks from above
  }
  EXPECT_GT(visible, 1000);
  EXPECT_GT(start->near, 1);
  EXPECT_LT(start->near, 4);
  scene.facts.has_alpha = false;
  EXPECT_THROW(StartAtSurfaces(BallModel(false, 0), scene, false, [](std::size_t) {}), InputError);
}

}  // namespace
}  // namespace nerf
