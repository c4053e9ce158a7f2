#include "nerf/sample/capture.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "nerf/data/camera.h"
#include "nerf/data/srgb.h"
#include "nerf/sample/camera_rings.h"
#include "nerf/sample/hash.h"
#include "nerf/sample/ray_tracer.h"
#include "sfm/input_error.h"
#include "sfm/parallel_for.h"

namespace nerf::sample {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kBounces = 2;

Ray RayThrough(const sfm::Camera& camera, const Eigen::Isometry3d& world_from_camera,
               const Vector2d& pixel) {
  const auto direction_in_camera = DirectionFromPixel(camera, pixel);
  if (!direction_in_camera) {
    throw sfm::InputError("the camera has no ray for pixel ({}, {}): choose another lens",
                          pixel.x(), pixel.y());
  }
  return {world_from_camera.translation(), world_from_camera.linear() * *direction_in_camera};
}

// The i-th of the points that fill the unit square evenly, whatever their number.
// Source: Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences" (R2), shifted as
// by Cranley and Patterson 1976.
Vector2d SpreadPoint(int i, const Vector2d& shift) {
  const double x = shift.x() + 0.7548776662466927 * i;
  const double y = shift.y() + 0.5698402909980532 * i;
  return {x - std::floor(x), y - std::floor(y)};
}

void Store(const Vector3d& value, float* pixel) {
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(value[c]);
}

Color PixelRadiance(const Scene& scene, const sfm::Camera& camera,
                    const Eigen::Isometry3d& world_from_camera, int x, int y, int samples_per_pixel,
                    unsigned seed) {
  const Vector2d shift(UnitFromHash(Hash(x, y, 0, seed)), UnitFromHash(Hash(x, y, 1, seed)));
  Color sum = Color::Zero();
  for (int i = 0; i < samples_per_pixel; ++i) {
    const Vector2d pixel = Vector2d(x, y) + SpreadPoint(i, shift);
    sum += Radiance(scene, RayThrough(camera, world_from_camera, pixel), kBounces);
  }
  return sum / samples_per_pixel;
}

void StorePhoto(const Color& radiance, float* pixel) {
  for (int c = 0; c < 3; ++c) {
    pixel[c] = SrgbFromLinear(std::clamp(static_cast<float>(radiance[c]), 0.0f, 1.0f));
  }
}

}  // namespace

View RenderView(const Scene& scene, const sfm::Camera& camera,
                const Eigen::Isometry3d& world_from_camera, int samples_per_pixel, unsigned seed) {
  const int width = camera.width;
  const int height = camera.height;
  View view{Image(width, height, 3, ColorEncoding::kSrgb),
            Image(width, height, 1, ColorEncoding::kLinear),
            Image(width, height, 3, ColorEncoding::kLinear),
            Image(width, height, 3, ColorEncoding::kLinear)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      StorePhoto(PixelRadiance(scene, camera, world_from_camera, x, y, samples_per_pixel, seed),
                 view.photo.At(x, y));
      const Vector2d center(x + 0.5, y + 0.5);
      const auto hit = Trace(scene, RayThrough(camera, world_from_camera, center));
      if (!hit) continue;
      *view.depth.At(x, y) = static_cast<float>(hit->distance);
      Store(hit->normal_in_world, view.normal.At(x, y));
      Store(hit->albedo, view.albedo.At(x, y));
    }
  }
  return view;
}

void RenderViews(const Scene& scene, const sfm::PosedImages& posed, const SampleOptions& options,
                 const std::function<void(int, View)>& consume) {
  options.Check();
  const int count = static_cast<int>(posed.images.size());
  std::mutex consuming;
  sfm::ParallelFor(count, options.threads, [&](int i) {
    const sfm::PosedImage& image = posed.images[i];
    View view = RenderView(scene, posed.cameras[image.camera], image.world_from_camera,
                           options.samples_per_pixel, Hash(i, 0, 0, options.seed));
    const std::lock_guard lock(consuming);
    consume(i, std::move(view));
  });
}

Capture MakeCapture(const SampleOptions& options) {
  Capture capture;
  capture.posed = CameraRings(options);
  capture.views.resize(capture.posed.images.size());
  RenderViews(BuiltInScene(), capture.posed, options,
              [&](int i, View view) { capture.views[i] = std::move(view); });
  return capture;
}

}  // namespace nerf::sample
