#include "nerf/pipeline/gaussian_session.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/model/evaluation.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/pipeline/surface_points.h"
#include "nerf/render/non_finite_error.h"
#include "nerf/splats/gaussian_fit.h"

namespace nerf {
namespace {

// Gaussians that are nearer to a camera than this share of what it sees are not drawn: they would
// hang in front of it, to explain one photograph.
constexpr double kNearShare = 0.5;

// The configuration of the run with assignments to its splats.
Config ConfigOf(const OpenedRun& run, const std::vector<std::string>& assignments) {
  nlohmann::json json = JsonFromConfig(run.model->GetConfig());
  const nlohmann::json given = JsonFromConfig(LoadConfig("base", assignments));
  for (const std::string& assignment : assignments) {
    const std::string key = assignment.substr(0, assignment.find('='));
    if (!key.starts_with("splats.")) {
      throw InputError("--set {}: nerf splat takes keys of splats; others are those of the run",
                       assignment);
    }
    json["splats"][key.substr(7)] = given["splats"][key.substr(7)];
  }
  return ConfigFromJson(json, "splats");
}

// Thrown by listeners where the user asks to stop.
struct Stopped {};

// Brings the photographs to the mean exposure, by the gains that the run has learned.
void RemoveExposures(const Model& model, std::vector<View>& views) {
  if (!model.exposure) return;
  for (View& view : views) {
    const std::array<float, 3> gains = GainsOf(model, view.name);
    for (std::size_t i = 0; i < view.rgba.size(); ++i) {
      if (i % 4 == 3) continue;
      view.rgba[i] = static_cast<Eigen::half>(static_cast<float>(view.rgba[i]) / gains[i % 4]);
    }
  }
}

double ValidationPsnr(const SceneModel& model, const PosedImages& posed) {
  const std::vector<const PosedImage*> images = ImagesOf(posed, Split::kValidation);
  if (images.empty()) return 0;
  const Evaluation evaluation = Evaluate(model, posed, images, {});
  return evaluation.scores.empty() ? 0 : evaluation.Mean().psnr;
}

// How far a fit is, by iterations or by time.
class FitClock {
 public:
  FitClock(const SplatOptions& options, double seconds) : options_(options), seconds_(seconds) {}

  FitProgress At(std::int64_t step) const {
    const auto taken = static_cast<double>(step);
    if (seconds_ == 0) {
      return {std::min(1.0, taken / options_.steps), static_cast<double>(options_.steps)};
    }
    const double spent = watch_.Seconds();
    // An iteration at half the resolution takes about 0.4 of the time of another.
    constexpr double kHalf = 0.4;
    const double half = options_.half_resolution;
    const double fraction = std::min(1.0, spent / seconds_);
    const double cost = std::min(fraction, half) / kHalf + std::max(0.0, fraction - half);
    const double all = half / kHalf + (1 - half);
    return {fraction, step < kWarmUp ? kAssumedSteps : taken * all / cost};
  }

 private:
  static constexpr int kWarmUp = 20;
  static constexpr double kAssumedSteps = 2000;
  const SplatOptions& options_;
  double seconds_;
  Stopwatch watch_;
};

GaussianSummary FitToRun(const GaussianRequest& request, const Stopwatch& watch,
                         const std::atomic<bool>& stop, const PipelineListener& listener) {
  const OpenedRun run = OpenRun(request.run);
  const Config config = ConfigOf(run, request.assignments);
  const SceneFacts& scene = run.model->Scene();
  if (scene.encoding == ColorEncoding::kLinear) {
    throw InputError(
        "{}: its photographs are linear, to which Gaussians are not fitted yet; render "
        "its field: --with field",
        request.run.string());
  }
  SplatOptions options = config.splats;
  if (!config.effects.view_dependence) options.harmonics_order = 0;

  Dataset data =
      LoadPhotographs(run.posed, config, scene.normalized_from_world, request.run, listener);
  RemoveExposures(run.model->GetModel(), data.train);
  const SurfacePoints surfaces =
      FindSurfacePoints(*run.model, data.train, options.count, [&](std::size_t done) {
        listener(SurfacesRendered{done, data.train.size()});
        if (stop) throw Stopped();
      });
  if (surfaces.points.empty()) {
    throw InputError("{}: its views agree on no surface; train it longer", request.run.string());
  }
  const double near = std::max(config.march.near_distance, kNearShare * surfaces.nearest);
  GaussianFit fit(
      data.train, scene.has_alpha,
      GaussiansAtPoints(surfaces.points, options.count, options.harmonics_order, config.train.seed),
      options, near, config.train.seed);
  const double seconds =
      request.time_budget == 0 ? 0 : std::max(1.0, request.time_budget - watch.Seconds());
  const FitClock clock(options, seconds);
  const Stopwatch fitting;
  FitProgress progress = clock.At(0);
  while (progress.fraction < 1 && !stop) {
    const double loss = fit.Step(progress);
    if (!std::isfinite(loss)) {
      throw NonFiniteError(fmt::format(
          "the loss of iteration {} of the Gaussians is not finite; try smaller rates: --set "
          "splats.mean_rate={}",
          fit.Steps(), options.mean_rate / 3));
    }
    progress = clock.At(fit.Steps());
    listener(GaussiansStepped{fit.Steps(), progress.fraction, loss});
  }
  if (fit.Steps() == 0) throw Stopped();
  const GaussianModel model(config, scene, fit.Cloud(), near, fit.Steps());
  GaussianSummary summary;
  summary.finished = progress.fraction >= 1;
  summary.steps = fit.Steps();
  summary.gaussians = model.Cloud().count;
  summary.seconds = fitting.Seconds();
  WriteGaussians(model, GaussiansPath(request.run));
  if (stop) return summary;
  summary.psnr = ValidationPsnr(model, run.posed);
  summary.field_psnr = ValidationPsnr(*run.model, run.posed);
  return summary;
}

}  // namespace

GaussianSummary MakeGaussians(const GaussianRequest& request, const Stopwatch& watch,
                              const std::atomic<bool>& stop, const PipelineListener& listener) {
  try {
    return FitToRun(request, watch, stop, listener);
  } catch (const Stopped&) {
    return {};
  }
}

}  // namespace nerf
