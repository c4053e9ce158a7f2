#include "nerf/pipeline/surface_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/scene/camera.h"
#include "tests/support/analytic_capture.h"

namespace nerf {
namespace {

constexpr double kRadius = 0.6;

// A red ball at the origin, before a blue sky.
class BallModel : public SceneModel {
 public:
  explicit BallModel(bool has_alpha) { scene_.has_alpha = has_alpha; }

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
        const double root = along * along - origin.squaredNorm() + kRadius * kRadius;
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
  Config config_;
  SceneFacts scene_;
};

SurfacePoints PointsOf(bool has_alpha, std::int64_t wanted) {
  const auto grey = [](const Eigen::Vector3f&, const Eigen::Vector3f&) -> Eigen::Vector4f {
    return Eigen::Vector4f::Constant(0.5f);
  };
  const test::AnalyticCapture capture(test::CameraRing(24, 2, 0.5), 120, 120, grey);
  return *FindSurfacePoints(BallModel(has_alpha), TargetViewsOf(capture.data.train), wanted, false,
                            [](std::size_t) {});
}

TEST(SurfacePoints, AreOnTheSurface) {
  const SurfacePoints found = PointsOf(true, 4000);
  EXPECT_GT(found.points.size(), 2000u);
  EXPECT_LE(found.points.size(), 4000u);
  for (const ColoredPoint& point : found.points) {
    EXPECT_NEAR(point.x_in_normalized.norm(), kRadius, 1e-4);
    EXPECT_EQ(point.rgb, Eigen::Vector3f(0.7f, 0, 0));
  }
  EXPECT_NEAR(found.nearest, std::hypot(2, 0.5) - kRadius, 0.1);
}

TEST(SurfacePoints, WithoutASurfaceAreASky) {
  const SurfacePoints found = PointsOf(false, 4000);
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

}  // namespace
}  // namespace nerf
