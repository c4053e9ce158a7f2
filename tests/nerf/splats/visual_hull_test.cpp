#include "nerf/splats/visual_hull.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr double kRadius = 0.5;

// A green ball at the origin from around it, or nothing.
std::vector<View> Photographs(bool has_ball) {
  constexpr int kSide = 200;
  std::vector<View> views;
  for (int i = 0; i < 40; ++i) {
    View view;
    view.camera = PinholeFromFov(kSide, kSide, 0.7);
    view.normalized_from_camera =
        Eigen::Isometry3d(Eigen::AngleAxisd(0.7 * i, Eigen::Vector3d::UnitY()) *
                          Eigen::AngleAxisd(0.8 * std::sin(1.3 * i), Eigen::Vector3d::UnitX()));
    view.normalized_from_camera.translate(Eigen::Vector3d(0, 0, -3));
    const Eigen::Vector3d origin = view.normalized_from_camera.translation();
    for (int pixel = 0; pixel < kSide * kSide; ++pixel) {
      const Eigen::Vector3d direction =
          view.normalized_from_camera.linear() *
          *DirectionFromPixel(view.camera, {pixel % kSide + 0.5, pixel / kSide + 0.5});
      const bool meets = origin.cross(direction).norm() < kRadius && has_ball;
      for (const float value : {0.2f, 0.8f, 0.4f, 1.0f}) {
        view.rgba.push_back(static_cast<Eigen::half>(meets ? value : 0.0f));
      }
    }
    views.push_back(std::move(view));
  }
  return views;
}

TEST(VisualHull, OfABallIsItsSurface) {
  const std::vector<View> views = Photographs(true);
  constexpr std::int64_t kWanted = 6000;
  const std::vector<ColoredPoint> points = VisualHull(TargetViewsOf(views), kWanted);
  EXPECT_GT(points.size(), kWanted * 0.8);
  EXPECT_LT(points.size(), kWanted * 1.25);
  for (const ColoredPoint& point : points) {
    // Pixels of the silhouettes are 0.01 there.
    EXPECT_GT(point.x_in_normalized.norm(), kRadius - 0.05);
    EXPECT_LT(point.x_in_normalized.norm(), kRadius + 0.05);
    EXPECT_NEAR(point.rgb[1], 0.8f, 0.05f);
  }
}

TEST(VisualHull, OfNothingIsEmpty) {
  const std::vector<View> views = Photographs(false);
  EXPECT_TRUE(VisualHull(TargetViewsOf(views), 1000).empty());
}

}  // namespace
}  // namespace nerf
