#include "nerf/pipeline/surface_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/pipeline/gaussian_scene.h"
#include "nerf/scene/camera.h"
#include "tests/support/analytic_capture.h"

namespace nerf {
namespace {

constexpr double kRadius = 0.6;

// A red ball at the origin, before a blue sky.
class BallModel : public SceneModel {
 public:
  explicit BallModel(bool has_alpha, double radius = kRadius) : radius_(radius) {
    scene_.has_alpha = has_alpha;
  }

  RenderedView Render(const ViewRequest& view) const override {
    const int width = view.camera.width, height = view.camera.height;
    RenderedView rendered;
    rendered.rgb = Image(width, height, 3);
    rendered.opacity = rendered.depth = Image(width, height, 1);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Eigen::Vector3d direction =
            view.world_from_camera.linear() * *DirectionFromPixel(view.camera, {x + 0.5, y + 0.5});
        const Eigen::Vector3d origin = view.world_from_camera.translation();
        const double along = origin.dot(direction);
        const double root = along * along - origin.squaredNorm() + radius_ * radius_;
        const bool meets = root > 0;
        rendered.rgb.At(x, y)[meets ? 0 : 2] = 0.7f;
        *rendered.opacity.At(x, y) = meets;
        *rendered.depth.At(x, y) = meets ? static_cast<float>(-along - std::sqrt(root)) : 0.0f;
      }
    }
    return rendered;
  }
  const Config& GetConfig() const override { return config_; }
  const SceneFacts& Scene() const override { return scene_; }
  std::int64_t Step() const override { return 0; }

 private:
  double radius_;
  Config config_;
  SceneFacts scene_;
};

// Photographs of the ball, which is all that they have.
test::AnalyticCapture CaptureOfBall() {
  const auto ball = [](const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
    const bool meets = origin.cross(direction).norm() < static_cast<float>(kRadius);
    return meets ? Eigen::Vector4f(0.7f, 0, 0, 1) : Eigen::Vector4f::Zero().eval();
  };
  return {test::CameraRing(24, 4, 1), 120, 120, ball, true};
}

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
    EXPECT_NEAR(point.x_in_normalized.norm(), kRadius, 1e-4);
    EXPECT_EQ(point.rgb, Eigen::Vector3f(0.7f, 0, 0));
  }
  EXPECT_NEAR(found.nearest, std::hypot(4, 1) - kRadius, 0.2);
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
    EXPECT_GT(mean.norm(), kRadius - 0.1);
    EXPECT_LT(mean.norm(), kRadius + 0.3);  // no camera looks from above
  }
  EXPECT_GT(visible, 1000);
  EXPECT_GT(start->near, 1);
  EXPECT_LT(start->near, 4);
  scene.facts.has_alpha = false;
  EXPECT_THROW(StartAtSurfaces(BallModel(false, 0), scene, false, [](std::size_t) {}), InputError);
}

}  // namespace
}  // namespace nerf
