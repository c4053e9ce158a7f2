#include "nerf/pipeline/gaussian_scene.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nerf/base/available_memory.h"
#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"
#include "nerf/effects/effects.h"
#include "nerf/model/refined_poses.h"
#include "nerf/pipeline/surface_points.h"
#include "nerf/scene/camera.h"
#include "nerf/splats/visual_hull.h"

namespace nerf {
namespace {

// Gaussians that are nearer to a camera than this share of what it sees are not drawn: they would
// hang in front of it, to explain one photograph.
constexpr double kNearShare = 0.5;
constexpr double kNearQuantile = 0.02;  // of the distances from a camera, at a visual hull

// A field takes seconds to render the depth for so many; more would cost more time than they are
// worth: splitting makes the other Gaussians.
constexpr int kMostPoints = 80000;

// Gaussians where their number is not given: it grows with the side of the photographs in a short
// fit, and with their pixels in one that has time to place so many.
constexpr double kFewestChosen = 50000, kMostChosen = 200000, kPixelsOfFewest = 400 * 400;
constexpr double kShortFit = 45, kLongFit = 120;  // seconds
// What is left of the part of a fit in full, and above a quarter, with photographs of so many times
// the pixels.
constexpr double kFullByPixels = -0.25;
constexpr double kFewestOfAll = 1000;  // where memory is short; fewer are no scene

// Of a Gaussian beside its parameters and their two moments: projections, and what it has in about
// ten tiles.
constexpr double kBytesBeside = 700;

double MegabytesOfEach(const SplatOptions& options) {
  const double values = kernels::GaussianRows(options.harmonics_order);
  return 1e-6 * (3 * sizeof(float) * values + kBytesBeside);
}

std::vector<TargetView> RefinedViews(const Model& field, const std::vector<View>& views,
                                     bool has_gains) {
  std::vector<TargetView> targets = TargetViewsOf(views);
  for (TargetView& target : targets) {
    const View& view = *target.photograph;
    RefineView(field, view.name, view.lens, target.normalized_from_camera, target.camera);
    if (has_gains) target.gains = GainsOf(field, view.name);
  }
  return targets;
}

SurfacePoints HullOf(const std::vector<TargetView>& views, std::int64_t wanted) {
  SurfacePoints hull{VisualHull(views, wanted), std::numeric_limits<double>::infinity()};
  for (const TargetView& view : views) {
    std::vector<double> distances;
    for (const ColoredPoint& point : hull.points) {
      distances.push_back(
          (point.x_in_normalized - view.normalized_from_camera.translation()).norm());
    }
    if (!distances.empty())
      hull.nearest = std::min(hull.nearest, Quantile(distances, kNearQuantile));
  }
  return hull;
}

}  // namespace

SplatOptions SplatOptionsFor(const SplatOptions& options, const Dataset& data, double seconds) {
  if (options.count > 0) return options;  // also where this was done before
  double pixels = 0;
  for (const View& view : data.train) pixels += static_cast<double>(PixelCount(view.camera));
  pixels /= static_cast<double>(std::max<std::size_t>(1, data.train.size()));
  const double larger = std::max(1.0, pixels / kPixelsOfFewest);
  const double time =
      seconds > 0 ? std::log(seconds / kShortFit) / std::log(kLongFit / kShortFit) : 1;
  const double growth = std::pow(larger, 0.5 + 0.5 * std::clamp(time, 0.0, 1.0));
  SplatOptions result = options;
  for (double* const part : {&result.quarter_resolution, &result.half_resolution}) {
    *part = 1 - (1 - *part) * std::pow(larger, kFullByPixels);
  }
  result.count = static_cast<int>(std::clamp(kFewestChosen * growth, kFewestChosen, kMostChosen));
  const double fitting = AvailableMegabytes() / MegabytesOfEach(options);
  if (fitting < result.count) result.count = static_cast<int>(std::max(fitting, kFewestOfAll));
  return result;
}

GaussianScene GaussianSceneOf(const Model& field, const Dataset& data, double seconds) {
  return GaussianSceneOf(field, field.config.splats, data, seconds);
}

GaussianScene GaussianSceneOf(const Model& field, const SplatOptions& splats, const Dataset& data,
                              double seconds) {
  if (field.scene.encoding == ColorEncoding::kLinear) {
    throw InputError(
        "the photographs are linear, to which Gaussians are not fitted yet; use the field: "
        "--representation field, --with field");
  }
  GaussianScene scene;
  scene.config = field.config;
  scene.config.splats = SplatOptionsFor(splats, data, seconds);
  if (!scene.config.effects.view_dependence) scene.config.splats.harmonics_order = 0;
  scene.facts = field.scene;
  scene.train = RefinedViews(field, data.train, field.exposure != nullptr);
  scene.validation = RefinedViews(field, data.validation, false);
  return scene;
}

std::string TooLittleMemory(const SplatOptions& options) {
  const double needed = options.count * MegabytesOfEach(options);
  const double available = AvailableMegabytes();
  if (needed <= available) return "";
  return fmt::format(
      "splats.count {}: the fit needs about {:.0f} MB, and {:.0f} MB are available; use at most "
      "{:.0f}",
      options.count, needed, available, options.count * available / needed);
}

void WarnOfFieldsEffects(const Config& config, const PipelineListener& listener) {
  const auto warn = [&](const EffectDescriptor& effect) {
    listener(Warning{
        fmt::format("{} acts on the field, at whose surfaces Gaussians begin, but not on their fit",
                    effect.name)});
  };
  if (config.effects.depth_supervision) warn(kDepthSupervisionEffect);
  if (config.effects.robust) warn(kRobustEffect);
}

std::optional<GaussianStart> StartAtSurfaces(const SceneModel& field, const GaussianScene& scene,
                                             const std::atomic<bool>& stop,
                                             const std::function<void(std::size_t)>& progress) {
  const SplatOptions& options = scene.config.splats;
  if (const std::string why_not = TooLittleMemory(options); !why_not.empty()) {
    throw InputError("{}", why_not);
  }
  const int wanted = std::min(options.count, kMostPoints);
  std::optional<SurfacePoints> surfaces =
      FindSurfacePoints(field, scene.train, wanted, stop, progress);
  if (!surfaces) return std::nullopt;
  if (surfaces->points.empty() && scene.facts.has_alpha) surfaces = HullOf(scene.train, wanted);
  if (stop) return std::nullopt;
  if (surfaces->points.empty()) {
    throw InputError("the views of the field agree on no surface; train it longer");
  }
  FitFacts made;
  made.field_step = field.Step();
  return GaussianStart{
      BeginFit(GaussiansAtPoints(surfaces->points, options.count, options.harmonics_order,
                                 scene.config.train.seed)),
      std::max(scene.config.march.near_distance, kNearShare * surfaces->nearest), made};
}

}  // namespace nerf
