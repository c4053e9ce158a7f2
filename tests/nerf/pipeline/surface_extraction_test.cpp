#include "nerf/pipeline/surface_extraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nerf/base/input_error.h"
#include "tests/support/ball_model.h"

namespace nerf {
namespace {

std::optional<ExtractedSurface> SurfaceOf(const test::BallModel& model,
                                          const std::atomic<bool>& stop = false) {
  const test::AnalyticCapture capture = test::CaptureOfBall();
  SurfaceExtractionOptions options;
  options.resolution = 40;
  return ExtractSurface(model, TargetViewsOf(capture.data.train), options, stop,
                        [](std::size_t) {});
}

TEST(SurfaceExtraction, FindsTheBallThatAModelRenders) {
  const auto surface = SurfaceOf(test::BallModel(true));
  ASSERT_TRUE(surface);
  ASSERT_GT(surface->mesh.vertices.size(), 1000u);
  double turned = 0, seen = 0;
  for (std::size_t i = 0; i < surface->mesh.vertices.size(); ++i) {
    const Eigen::Vector3d at = surface->mesh.vertices[i].cast<double>();
    if (std::abs(at.z()) > 0.4) continue;  // the poles, which no camera faces
    EXPECT_NEAR(at.norm(), test::kBallRadius, 0.02);
    const double cosine = surface->mesh.normals[i].cast<double>().dot(at.normalized());
    turned += std::acos(std::min(1.0, cosine));
    ++seen;
  }
  EXPECT_LT(turned / seen * 180 / std::numbers::pi, 4);
}

TEST(SurfaceExtraction, WithoutAnythingOpaqueItIsAnError) {
  EXPECT_THROW(SurfaceOf(test::BallModel(true, 0)), InputError);
}

TEST(SurfaceExtraction, CanBeStopped) { EXPECT_FALSE(SurfaceOf(test::BallModel(true), true)); }

}  // namespace
}  // namespace nerf
