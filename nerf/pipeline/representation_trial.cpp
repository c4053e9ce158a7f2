#include "nerf/pipeline/representation_trial.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/stopwatch.h"
#include "nerf/effects/exposure_fit.h"
#include "nerf/render/non_finite_error.h"
#include "nerf/scene/dataset.h"

namespace nerf {
namespace {

// The least part of a trial that is fitted, however long the surfaces took.
constexpr double kLeastFit = 0.5;
// At so few pixels and Gaussians a second of fitting reaches what a minute reaches in full.
constexpr int kLongestSideOfTrial = 160;  // pixels
constexpr int kFewerGaussians = 8;
constexpr double kHalfResolution = 0.3;
// dB. Until the end a field gains 1.5 to 3 dB more than Gaussians do (fox, chair, sample; 60 and
// 120 s). Captures on which Gaussians end ahead were ahead by 2.6 dB or more here, others by 1.4 or
// less.
constexpr double kPromise = 1.5;

// The scene at a resolution at which a trial is short.
GaussianScene ReducedScene(const Model& field, const Dataset& data) {
  GaussianScene scene = GaussianSceneOf(field, data, kLeastFit);
  int halvings = 0;
  for (const TargetView& view : scene.train) {
    const int side = std::max(view.camera.width, view.camera.height);
    while (side >> halvings > kLongestSideOfTrial) ++halvings;
  }
  for (auto* views : {&scene.train, &scene.validation}) {
    for (TargetView& view : *views) {
      int possible = halvings;
      while (std::min(view.camera.width, view.camera.height) >> possible < 1) --possible;
      view = Reduced(view, possible);
    }
  }
  SplatOptions& options = scene.config.splats;
  options.count = std::max(16, options.count / kFewerGaussians);
  options.quarter_resolution = 0;
  options.half_resolution = kHalfResolution;
  return scene;
}

// The pixels of a view that are compared, one after another.
struct Pixels {
  std::vector<float> shown, drawn;  // [P,3] on the display background
  std::vector<float> opacity;       // [P] drawn
  std::vector<float> weight;        // [P]
};

Pixels PixelsOf(const TargetPicture& target, const RenderedView& drawn,
                const Eigen::Vector3f& background) {
  Pixels pixels;
  for (int y = 0; y < target.height; ++y) {
    for (int x = 0; x < target.width; ++x) {
      const float weight = target.Row(TargetPicture::kWeight, y)[x];
      if (weight == 0) continue;
      const float alpha = target.Row(TargetPicture::kOpacity, y)[x];
      for (int c = 0; c < 3; ++c) {
        pixels.shown.push_back(alpha * target.Row(c, y)[x] + (1 - alpha) * background[c]);
        pixels.drawn.push_back(drawn.rgb.At(x, y)[c]);
      }
      pixels.opacity.push_back(*drawn.opacity.At(x, y));
      pixels.weight.push_back(weight);
    }
  }
  return pixels;
}

double Psnr(const Pixels& pixels) {
  double error = 0, weight = 0;
  for (std::size_t p = 0; p < pixels.weight.size(); ++p) {
    weight += 3 * pixels.weight[p];
    for (std::size_t at = 3 * p; at < 3 * p + 3; ++at) {
      const double d =
          std::clamp(pixels.drawn[at], 0.0f, 1.0f) - std::clamp(pixels.shown[at], 0.0f, 1.0f);
      error += pixels.weight[p] * d * d;
    }
  }
  return -10 * std::log10(std::max(error, 1e-10) / std::max(weight, 1e-10));
}

// The mean over views, each at its own exposure where exposures are simulated.
double MeanPsnr(const SceneModel& model, const std::vector<TargetView>& views) {
  const SceneFacts& facts = model.Scene();
  const Eigen::Vector3f background = DisplayBackground(facts.has_alpha);
  double sum = 0;
  for (const TargetView& view : views) {
    const RenderedView drawn = model.Render(
        {view.camera, facts.normalized_from_world.WorldFromCamera(view.normalized_from_camera)});
    Pixels pixels = PixelsOf(TargetOf(view), drawn, background);
    if (model.GetConfig().effects.exposure) {
      FitExposure(pixels.drawn, pixels.opacity, pixels.shown, {background.data(), 3},
                  facts.encoding);
    }
    sum += Psnr(pixels);
  }
  return sum / static_cast<double>(views.size());
}

}  // namespace

Trial TryGaussians(const Model& field, const Dataset& data, double seconds, std::int64_t steps,
                   const std::atomic<bool>& stop, const PipelineListener& listener) {
  const Stopwatch watch;
  const auto snapshot = ModelSnapshot::Copy(field, 0);
  const GaussianScene scene = ReducedScene(field, data);
  try {
    std::optional<GaussianStart> start =
        StartAtSurfaces(*snapshot, scene, stop, [](std::size_t) {});
    if (!start) return {};
    GaussianPlan plan;
    plan.steps = steps;
    if (seconds > 0) plan.seconds = std::max(kLeastFit * seconds, seconds - watch.Seconds());
    const GaussianResult result =
        FitGaussians(scene, std::move(*start), nullptr, plan, stop, listener);
    if (!result.summary.finished) return {};
    return {ComparedPsnr{MeanPsnr(*snapshot, scene.validation),
                         MeanPsnr(result.model, scene.validation)},
            ""};
  } catch (const InputError& error) {
    return {std::nullopt, error.what()};  // no surfaces
  } catch (const NonFiniteError& error) {
    return {std::nullopt, error.what()};
  }
}

bool SplatsPromiseMore(const ComparedPsnr& trial) { return trial.splats > trial.field + kPromise; }

}  // namespace nerf
