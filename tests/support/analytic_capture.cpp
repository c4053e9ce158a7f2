#include "tests/support/analytic_capture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "nerf/render/engine.h"
#include "nerf/render/view_renderer.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf::test {

std::vector<Eigen::Isometry3d> CameraRing(int count, double radius, double height) {
  std::vector<Eigen::Isometry3d> cameras;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count * 3.0;  // three turns of a spiral
    const Eigen::Vector3d centre(radius * std::cos(angle), radius * std::sin(angle),
                                 height * (2.0 * i / count - 1));
    const Eigen::Vector3d forward = -centre.normalized();
    const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();
    camera.linear() << right, forward.cross(right), forward;
    camera.translation() = centre;
    cameras.push_back(camera);
  }
  return cameras;
}

AnalyticCapture::AnalyticCapture(const std::vector<Eigen::Isometry3d>& cameras, int width,
                                 int height, const RadianceAlong& radiance, bool has_alpha,
                                 int hold_out_every) {
  data.has_alpha = has_alpha;
  const Camera lens = PinholeFromFov(width, height, 0.7);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    View view;
    view.name = std::to_string(i);
    view.camera = lens;
    view.normalized_from_camera = cameras[i];
    for (int pixel = 0; pixel < width * height; ++pixel) {
      const auto direction = *DirectionFromPixel(lens, {pixel % width + 0.5, pixel / width + 0.5});
      const Eigen::Vector4f rgba =
          radiance(cameras[i].translation().cast<float>(),
                   (cameras[i].linear() * direction).normalized().cast<float>());
      for (int c = 0; c < 4; ++c) view.rgba.emplace_back(rgba[c]);
    }
    const bool hold_out = hold_out_every > 0 && i % hold_out_every == 0;
    (hold_out ? held_out : data.train).push_back(std::move(view));
  }
  scene = FactsOf(data, scene.normalized_from_world);
}

double PsnrOver(const Model& model, const std::vector<View>& views) {
  double sum = 0;
  std::int64_t count = 0;
  for (const View& view : views) {
    std::vector<std::int64_t> pixels(view.StoredCount());
    std::iota(pixels.begin(), pixels.end(), 0);
    const ViewRays rays =
        RaysOfPixels(view.camera, view.normalized_from_camera, pixels, Eigen::Vector3f::Zero());
    const RenderOutput out = MakeRenderer(model)->Render(rays.rays);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const float alpha = static_cast<float>(view.rgba[4 * i + 3]);
      for (int c = 0; c < 3; ++c) {
        const double truth = static_cast<double>(alpha * static_cast<float>(view.rgba[4 * i + c]));
        const double error = static_cast<double>(out.rgb[3 * i + c]) - truth;
        sum += error * error;
        ++count;
      }
    }
  }
  return -10 * std::log10(sum / static_cast<double>(count));
}

}  // namespace nerf::test
