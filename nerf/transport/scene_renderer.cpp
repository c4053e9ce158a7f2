#include "nerf/transport/scene_renderer.h"

#include <atomic>
#include <cmath>
#include <optional>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/progress.h"
#include "nerf/transport/pixel_rays.h"

namespace nerf {
namespace {

using Eigen::Vector2d;

// Accumulates a picture pass by pass: colours, and the variance of luminance. The variance is taken
// at each position in a pixel separately, because differences between positions are detail, not
// noise.
class Accumulator {
 public:
  Accumulator(int width, int height, int positions)
      : width_(width),
        height_(height),
        positions_(positions),
        color_(static_cast<std::size_t>(width) * height, Color::Zero()),
        luminance_(color_.size() * static_cast<std::size_t>(positions), 0),
        luminance2_(luminance_.size(), 0) {}

  void Add(std::size_t pixel, int position, const Color& color) {
    const double luminance = Luminance(color);
    const std::size_t at = pixel * static_cast<std::size_t>(positions_) + position;
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
      const Color mean = color_[pixel] / (passes * positions_);
      for (int c = 0; c < 3; ++c) {
        result.color.pixels[pixel * 3 + static_cast<std::size_t>(c)] = static_cast<float>(mean[c]);
      }
      double variance = 0;
      for (int position = 0; position < positions_ && passes > 1; ++position) {
        const std::size_t at = pixel * static_cast<std::size_t>(positions_) + position;
        const double m = luminance_[at] / passes;
        const double spread = std::max(0.0, luminance2_[at] / passes - m * m) / (passes - 1);
        variance += spread / (positions_ * positions_);
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
  int positions_;
  std::vector<Color> color_;
  std::vector<double> luminance_;   // [pixel][position]
  std::vector<double> luminance2_;  // [pixel][position]
};

}  // namespace

void RenderSettings::Check() const {
  if (positions < 1 || positions > 64) {
    throw InputError("RenderSettings::positions is {}: choose 1 to 64", positions);
  }
  if (paths_per_position < 1 || paths_per_position > 1'000'000) {
    throw InputError("--paths is {}: choose a number from 1 to 1000000", paths_per_position);
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
  Accumulator sums(width, height, settings.positions);
  std::atomic<std::int64_t> rays = 0;
  std::optional<ProgressLine> progress;
  if (!title.empty()) progress.emplace(title, settings.paths_per_position);
  int passes = 0;
  std::string noise_text;
  bool finished = true;
  while (passes < settings.paths_per_position) {
    if (!keep_on()) {
      finished = false;
      break;
    }
    ParallelForEach(height, [&](std::int64_t y) {
      std::int64_t row_rays = 0;
      for (int x = 0; x < width; ++x) {
        const auto pixel = static_cast<std::size_t>(y) * width + x;
        for (int position = 0; position < settings.positions; ++position) {
          const Vector2d at = Vector2d(x, static_cast<double>(y)) + PositionInPixel(position);
          UniformStream random(settings.seed, pixel,
                               static_cast<std::uint64_t>(passes) * settings.positions + position);
          sums.Add(
              pixel, position,
              tracer.Radiance(RayThroughPixel(camera, world_from_camera, at), random, row_rays));
        }
      }
      rays += row_rays;
    });
    ++passes;
    // Computing the noise takes time, so only after 2, 4, 8, ... passes.
    const bool measure = passes > 1 && (passes & (passes - 1)) == 0;
    const double noise = measure ? sums.Result(passes).noise : 0;
    if (measure) noise_text = fmt::format("noise {:.2f} %", 100 * noise);
    if (progress) progress->Update(passes, noise_text);
    if (measure && settings.stop_at_noise > 0 && noise <= settings.stop_at_noise) break;
  }
  SceneRendering result = sums.Result(std::max(1, passes));
  result.rays = rays;
  result.finished = finished;
  return result;
}

}  // namespace nerf
