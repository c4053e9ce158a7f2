#pragma once

#include <cmath>

#include "nerf/model/scene_model.h"
#include "nerf/scene/camera.h"
#include "tests/support/analytic_capture.h"

namespace nerf::test {

inline constexpr double kBallRadius = 0.6;

// A red ball at the origin, before a blue sky.
class BallModel : public SceneModel {
 public:
  explicit BallModel(bool has_alpha, double radius = kBallRadius) : radius_(radius) {
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
inline AnalyticCapture CaptureOfBall() {
  const auto ball = [](const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
    const bool meets = origin.cross(direction).norm() < static_cast<float>(kBallRadius);
    return meets ? Eigen::Vector4f(0.7f, 0, 0, 1) : Eigen::Vector4f::Zero().eval();
  };
  return {CameraRing(24, 4, 1), 120, 120, ball, true};
}

}  // namespace nerf::test
