#include "nerf/transport/scene_renderer.h"

#include <atomic>
#include <cmath>
#include <optional>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/progress.h"
#include "nerf/scene/camera.h"
#include "nerf/transport/pixel_rays.h"

namespace nerf {
namespace {

using Eigen::Vector2d;

const Vector2d kShift(0.5, 0.5);  // the first place is the middle of the pixel

// Adds up a picture pass by pass: colours, and the spread of luminance at each place by itself, for
// differences between places are detail and no noise.
class Accumulator {
 public:
  Accumulator(int width, int height, int places)
      : width_(width),
        height_(height),
        places_(places),
        color_(static_cast<std::size_t>(width) * height, Color::Zero()),
        luminance_(color_.size() * static_cast<std::size_t>(places), 0),
        luminance2_(luminance_.size(), 0) {}

  void Add(std::size_t pixel, int place, const Color& color) {
    const double luminance = Luminance(color);
    const std::size_t at = pixel * static_cast<std::size_t>(places_) + place;
    color_[pixel] += color;
    luminance_[at] += luminance;
    luminance2_[at] += luminance * luminance;
  }

  SceneRendering Result(int passes) const {
    SceneRendering result{Image(width_, height_, 3, ColorEncoding::kLinear),
                          Image(width_, height_, 1, ColorEncoding::kLinear)};
    double variances = 0;
    double sum = 0;
    for (std::size_t pixel = 0; pixel < color_.size(); ++pixel) {
      const Color mean = color_[pixel] / (passes * places_);
      for (int c = 0; c < 3; ++c) {
        result.color.pixels[pixel * 3 + static_cast<std::size_t>(c)] = static_cast<float>(mean[c]);
      }
      double variance = 0;
      for (int place = 0; place < places_ && passes > 1; ++place) {
        const std::size_t at = pixel * static_cast<std::size_t>(places_) + place;
        const double m = luminance_[at] / passes;
        const double spread = std::max(0.0, luminance2_[at] / passes - m * m) / (passes - 1);
        variance += spread / (places_ * places_);
      }
      result.deviation.pixels[pixel] = static_cast<float>(std::sqrt(variance));
      variances += variance;
      sum += Luminance(mean);
    }
    const auto count = static_cast<double>(color_.size());
    result.noise = sum > 0 ? std::sqrt(variances / count) / (sum / count) : 0;
    return result;
  }

 private:
  int width_;
  int height_;
  int places_;
  std::vector<Color> color_;
  std::vector<double> luminance_;   // [pixel][place]
  std::vector<double> luminance2_;  // [pixel][place]
};

}  // namespace

void RenderSettings::Check() const {
  if (places < 1 || places > 64) {
    throw InputError("RenderSettings::places is {}: choose 1 to 64", places);
  }
  if (paths_per_place < 1 || paths_per_place > 1'000'000) {
    throw InputError("--paths is {}: choose a number from 1 to 1000000", paths_per_place);
  }
  if (!(stop_at_noise >= 0))
    throw InputError("RenderSettings::stop_at_noise is {}: choose 0 or more", stop_at_noise);
}

SceneRendering RenderScene(const SurfaceScene& scene, const TransportTerms& terms,
                           const Camera& camera, const Eigen::Isometry3d& world_from_camera,
                           const RenderSettings& settings, const std::string& title,
                           const std::function<bool()>& keep_on) {
  settings.Check();
  const PathTracer tracer(scene, terms, settings.seed);
  const int width = camera.width;
  const int height = camera.height;
  Accumulator sums(width, height, settings.places);
  std::atomic<std::int64_t> rays = 0;
  std::optional<ProgressLine> progress;
  if (!title.empty()) progress.emplace(title, settings.paths_per_place);
  int passes = 0;
  std::string noise_left;
  bool finished = true;
  while (passes < settings.paths_per_place) {
    if (!keep_on()) {
      finished = false;
      break;
    }
    ParallelForEach(height, [&](std::int64_t y) {
      std::int64_t row_rays = 0;
      for (int x = 0; x < width; ++x) {
        const auto pixel = static_cast<std::size_t>(y) * width + x;
        for (int place = 0; place < settings.places; ++place) {
          const Vector2d at = Vector2d(x, static_cast<double>(y)) + PointInPixel(place, kShift);
          UniformStream random(settings.seed, pixel,
                               static_cast<std::uint64_t>(passes) * settings.places + place);
          sums.Add(
              pixel, place,
              tracer.Radiance(RayThroughPixel(camera, world_from_camera, at), random, row_rays));
        }
      }
      rays += row_rays;
    });
    ++passes;
    // Noise is worth its arithmetic every so often: at powers of two.
    const bool look = passes > 1 && (passes & (passes - 1)) == 0;
    const double noise = look ? sums.Result(passes).noise : 0;
    if (look) noise_left = fmt::format("noise {:.2f} %", 100 * noise);
    if (progress) progress->Update(passes, noise_left);
    if (look && settings.stop_at_noise > 0 && noise <= settings.stop_at_noise) break;
  }
  SceneRendering result = sums.Result(std::max(1, passes));
  result.rays = rays;
  result.finished = finished;
  return result;
}

}  // namespace nerf
