#include "nerf/effects/anti_aliasing.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "nerf/base/quantile.h"
#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Standard deviation of a uniform distribution of width 1.
constexpr float kUniformDeviation = 0.28867513f;
// The ball of radius 2 of contracted space fills the unit cube.
constexpr float kCubeFromContracted = 0.25f;
// Beyond this erf rounds to 1 in float.
constexpr float kErfSaturation = 4;

constexpr double kScaleRatio = 2.2;  // threshold: largest over smallest scale of a point, median
constexpr double kSmallest = 0.1, kLargest = 0.9;  // as these quantiles of a point's scales

}  // namespace

std::vector<float> Footprints(const RayBatch& rays, std::span<const std::int64_t> ray,
                              std::span<const float> t, const AntiAliasingOptions& options) {
  std::vector<float> footprint(t.size(), 0.0f);
  if (rays.spread.empty()) return footprint;
  const float unit = static_cast<float>(options.pixels) * kUniformDeviation * kCubeFromContracted;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::int64_t r = ray[i];
    const Eigen::Vector3f x =
        Eigen::Vector3f(&rays.origin[3 * r]) + t[i] * Eigen::Vector3f(&rays.direction[3 * r]);
    const float inverse = 1 / std::max(1.0f, x.stableNorm());
    footprint[i] = unit * rays.spread[r] * t[i] * (2 - inverse) * inverse;
  }
  return footprint;
}

std::vector<float> AntiAliasingWeights(const kernels::HashGridLayout& layout,
                                       std::span<const float> footprint) {
  const std::size_t levels = layout.levels.size();
  std::vector<float> weights(levels * footprint.size());
  for (std::size_t i = 0; i < footprint.size(); ++i) {
    // Infinite for a footprint of 0, whose weights are then 1.
    const float inverse = 1 / (std::sqrt(8.0f) * footprint[i]);
    for (std::size_t l = 0; l < levels; ++l) {
      const float x = inverse / static_cast<float>(layout.levels[l].resolution);
      weights[i * levels + l] = x > kErfSaturation ? 1.0f : std::erf(x);
    }
  }
  return weights;
}

Verdict JudgeAntiAliasing(const PosedImages& posed) {
  std::vector<double> ratios;  // one per sighting: points with long tracks count more
  for (const SparsePoint& point : posed.points) {
    std::vector<double> footprints;  // width of a pixel at the point, world units
    for (const TrackElement& seen : point.track) {
      const PosedImage& image = posed.images[seen.image];
      const double distance = (point.x_in_world - image.world_from_camera.translation()).norm();
      footprints.push_back(distance / FocalLength(posed.cameras[image.camera]));
    }
    const double smallest = Quantile(footprints, kSmallest);
    if (smallest > 0) {
      const double ratio = Quantile(footprints, kLargest) / smallest;
      ratios.insert(ratios.end(), point.track.size(), ratio);
    }
  }
  if (ratios.empty()) return Undecided(kAntiAliasingEffect.name, "no tracks of sparse points");
  const double median = Quantile(ratios, 0.5);
  return Measured(kAntiAliasingEffect.name, median, kScaleRatio,
                  fmt::format("the scales at which photographs show a point differ by a factor of "
                              "{:.1f} (threshold {:.1f})",
                              median, kScaleRatio));
}

const EffectDescriptor kAntiAliasingEffect = {
    .name = "anti_aliasing",
    .old_name = "footprint",
    .help = "a pixel averages a patch that grows with the distance: finer levels get less weight",
    .stage = "encode",
    .judge =
        [](const CaptureEvidence& e) {
          return e.HasTracks() ? JudgeAntiAliasing(*e.posed)
                               : Undecided(kAntiAliasingEffect.name, e.unknown_because);
        },
};

}  // namespace nerf
