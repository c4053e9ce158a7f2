#include "nerf/synthetic/capture.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "nerf/base/parallel.h"
#include "nerf/image/srgb.h"
#include "nerf/synthetic/camera_rings.h"
#include "nerf/synthetic/hash.h"
#include "nerf/synthetic/ray_tracer.h"
#include "nerf/transport/pixel_rays.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kBounces = 2;  // of mirrors

template <class Triple>
void Store(const Triple& value, float* pixel) {
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(value[c]);
}

// The pose of a camera that turns, when a share of the time has passed.
Eigen::Isometry3d Turned(const Eigen::Isometry3d& world_from_camera, const Vector3d& turn,
                         double share) {
  if (turn.isZero()) return world_from_camera;
  return world_from_camera * Eigen::AngleAxisd((share - 0.5) * turn.norm(), turn.normalized());
}

Color PixelRadiance(const Scene& scene, const Camera& camera,
                    const Eigen::Isometry3d& world_from_camera, const Vector3d& turn, int x, int y,
                    int samples_per_pixel, unsigned seed) {
  const Vector2d shift(UnitFromHash(Hash(x, y, 0, seed)), UnitFromHash(Hash(x, y, 1, seed)));
  Color sum = Color::Zero();
  for (int i = 0; i < samples_per_pixel; ++i) {
    const Vector2d pixel = Vector2d(x, y) + PointInPixel(i, shift);
    const auto pose = Turned(world_from_camera, turn, (i + 0.5) / samples_per_pixel);
    sum += Radiance(scene, RayThroughPixel(camera, pose, pixel), kBounces);
  }
  return sum / samples_per_pixel;
}

// Stores what a camera makes of the radiance of a pixel.
void StorePhoto(const Color& radiance, const PhotoSettings& settings, float* pixel) {
  for (int c = 0; c < 3; ++c) {
    const auto light = static_cast<float>(radiance[c] * settings.gain[c]);
    pixel[c] = settings.linear ? light : SrgbFromLinear(std::clamp(light, 0.0f, 1.0f));
  }
}

// Alpha of a pixel: the fraction of its rays that hit something.
double Alpha(const Scene& scene, const Camera& camera, const Eigen::Isometry3d& world_from_camera,
             int x, int y, int samples_per_pixel, unsigned seed) {
  const Vector2d shift(UnitFromHash(Hash(x, y, 0, seed)), UnitFromHash(Hash(x, y, 1, seed)));
  int hits = 0;
  for (int i = 0; i < samples_per_pixel; ++i) {
    const Vector2d pixel = Vector2d(x, y) + PointInPixel(i, shift);
    if (Trace(scene, RayThroughPixel(camera, world_from_camera, pixel))) ++hits;
  }
  return static_cast<double>(hits) / samples_per_pixel;
}

// Whether a passer-by is visible in a pixel or within half a pixel of it.
bool ShowsPasserBy(const std::vector<Object>& passers_by, const Scene& scene, const Camera& camera,
                   const Eigen::Isometry3d& world_from_camera, int x, int y) {
  for (const double dy : {-0.5, 0.5, 1.5}) {
    for (const double dx : {-0.5, 0.5, 1.5}) {
      const Vector2d pixel(std::clamp(x + dx, 0.0, static_cast<double>(camera.width)),
                           std::clamp(y + dy, 0.0, static_cast<double>(camera.height)));
      const Ray ray = RayThroughPixel(camera, world_from_camera, pixel);
      const auto passer_by = FirstHit(passers_by, ray);
      if (!passer_by) continue;
      const auto behind = Trace(scene, ray);
      if (!behind || passer_by->distance < behind->distance) return true;
    }
  }
  return false;
}

}  // namespace

View RenderView(const Scene& scene, const Camera& camera,
                const Eigen::Isometry3d& world_from_camera, int samples_per_pixel, unsigned seed,
                const PhotoSettings& settings) {
  const int width = camera.width;
  const int height = camera.height;
  View view{Image(width, height, settings.alpha ? 4 : 3,
                  settings.linear ? ColorEncoding::kLinear : ColorEncoding::kSrgb),
            std::nullopt, Image(width, height, 1, ColorEncoding::kLinear),
            Image(width, height, 3, ColorEncoding::kLinear),
            Image(width, height, 3, ColorEncoding::kLinear)};
  if (settings.mask) view.mask = Image(width, height, 1);
  Scene with_passers_by = scene;
  with_passers_by.objects.insert(with_passers_by.objects.end(), settings.passers_by.begin(),
                                 settings.passers_by.end());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Color light = PixelRadiance(with_passers_by, camera, world_from_camera, settings.turn, x, y,
                                  samples_per_pixel, seed);
      if (settings.alpha) {
        const double alpha =
            Alpha(with_passers_by, camera, world_from_camera, x, y, samples_per_pixel, seed);
        if (alpha > 0) light /= alpha;  // colour is straight, not premultiplied
        view.photo.At(x, y)[3] = static_cast<float>(alpha);
      }
      StorePhoto(light, settings, view.photo.At(x, y));
      if (view.mask) {
        const bool hidden =
            ShowsPasserBy(settings.passers_by, scene, camera, world_from_camera, x, y);
        *view.mask->At(x, y) = hidden ? 0.0f : 1.0f;
      }
      const Vector2d center(x + 0.5, y + 0.5);
      const auto hit = Trace(scene, RayThroughPixel(camera, world_from_camera, center));
      if (!hit) continue;
      *view.depth.At(x, y) = static_cast<float>(hit->distance);
      Store(hit->normal_in_world, view.normal.At(x, y));
      Store(hit->albedo, view.albedo.At(x, y));
    }
  }
  return view;
}

void RenderViews(const Scene& scene, const PosedImages& posed, const SampleOptions& options,
                 const std::function<void(int, View)>& consume) {
  options.Check();
  const int count = static_cast<int>(posed.images.size());
  std::mutex consuming;
  ParallelForEach(count, [&](std::int64_t item) {
    const int i = static_cast<int>(item);
    const PosedImage& image = posed.images[i];
    View view =
        RenderView(scene, posed.cameras[image.camera], image.world_from_camera,
                   options.samples_per_pixel, Hash(i, 0, 0, options.seed),
                   PhotoSettingsFor(options.scenario, i, options.seed, image.world_from_camera));
    const std::lock_guard lock(consuming);
    consume(i, std::move(view));
  });
}

Capture MakeCapture(const SampleOptions& options) {
  Capture capture;
  capture.posed = CameraRings(options);
  capture.views.resize(capture.posed.images.size());
  RenderViews(SceneFor(options.scenario), capture.posed, options,
              [&](int i, View view) { capture.views[i] = std::move(view); });
  return capture;
}

}  // namespace nerf::synthetic
