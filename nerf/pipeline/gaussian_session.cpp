#include "nerf/pipeline/gaussian_session.h"

#include <algorithm>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/model/representation_record.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/prepared_scene.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

// The configuration of the run with assignments to its splats.
Config ConfigOf(const Config& of_run, const std::vector<std::string>& assignments) {
  nlohmann::json json = JsonFromConfig(of_run);
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

std::optional<InterruptedFit> FitToResume(const fs::path& run) {
  OpenGaussians(run);  // names what is missing
  std::optional<InterruptedFit> fit = ReadInterruptedFit(GaussiansPath(run));
  if (!fit) {
    throw InputError("{}: its fit has ended; make Gaussians anew without --resume",
                     GaussiansPath(run).string());
  }
  return fit;
}

GaussianSession FitToRun(const GaussianRequest& request, const Stopwatch& watch,
                         const std::atomic<bool>& stop, const PipelineListener& listener) {
  const OpenedRun run = OpenRun(request.run);
  std::optional<InterruptedFit> interrupted;
  if (request.resume) interrupted = FitToResume(request.run);
  Model model = CloneModel(run.model->GetModel());
  model.config = request.resume ? OpenGaussians(request.run)->GetConfig()
                                : ConfigOf(model.config, request.assignments);
  const Dataset data =
      LoadPhotographs(sfm::ReadTransformsJson(PosesPath(request.run)), model.config,
                      model.scene.normalized_from_world, request.run, listener);
  const GaussianScene scene = GaussianSceneOf(model, data);
  const GaussianValidation validation(scene, data);
  const auto start = [&]() -> GaussianStart {
    if (interrupted) return {interrupted->state, OpenGaussians(request.run)->Near()};
    return StartAtSurfaces(*run.model, scene, [&](std::size_t done) {
      listener(SurfacesRendered{done, data.train.size()});
      if (stop) throw Stopped();
    });
  }();
  GaussianPlan plan;
  plan.steps = scene.config.splats.steps;
  plan.file = GaussiansPath(request.run);
  plan.checkpoint_every = scene.config.train.checkpoint_every;
  if (request.time_budget > 0) {
    plan.seconds = std::max(1.0, request.time_budget - watch.Seconds());
  }
  // What was compared before is overwritten.
  RepresentationRecord record = ReadRepresentation(request.run);
  if (record.reached) {
    record.reached.reset();
    WriteRepresentation(record, request.run);
  }
  GaussianSession session;
  session.fit = FitGaussians(scene, start, interrupted ? interrupted->seconds : 0, &validation,
                             plan, stop, listener)
                    .summary;
  if (!session.fit.finished || validation.Empty()) return session;
  session.reached = ComparedPsnr{validation.Psnr(model), session.fit.psnr};
  record.reached = session.reached;
  WriteRepresentation(record, request.run);
  return session;
}

}  // namespace

std::optional<GaussianSession> MakeGaussians(const GaussianRequest& request, const Stopwatch& watch,
                                             const std::atomic<bool>& stop,
                                             const PipelineListener& listener) {
  try {
    return FitToRun(request, watch, stop, listener);
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

}  // namespace nerf
