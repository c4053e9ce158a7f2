#include "nerf/pipeline/gaussian_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/model/representation_record.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/splats/gaussian_ply.h"
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

// Throws InputError where that is too few, or too many.
int CountFor(double megabytes, const Config& config) {
  const int order = config.effects.view_dependence ? config.splats.harmonics_order : 0;
  const double count = std::floor(1e6 * megabytes / static_cast<double>(BytesInPly(order)));
  constexpr double kFewest = 16, kMost = 1 << 24;
  if (!(count >= kFewest && count <= kMost)) {
    throw InputError("--megabytes {}: would be {:.0f} Gaussians; {:.0f} to {:.0f} are possible",
                     megabytes, count, kFewest, kMost);
  }
  return static_cast<int>(count);
}

// What was compared before is overwritten.
void ForgetReached(RepresentationRecord& record, const fs::path& run) {
  if (!record.reached && !record.splats_stand) return;
  record.ForgetReached();
  WriteRepresentation(record, run);
}

}  // namespace

std::optional<GaussianSession> MakeGaussians(const GaussianRequest& request, const Stopwatch& watch,
                                             const std::atomic<bool>& stop,
                                             const PipelineListener& listener) {
  const OpenedRun run = OpenRun(request.run);
  const fs::path file = GaussiansPath(request.run);
  GaussianPlan plan;
  std::optional<GaussianStart> start;
  const Model& field = run.model->GetModel();
  SplatOptions splats;
  if (request.resume) {
    splats = OpenGaussians(request.run)->GetConfig().splats;
    start = StartAgain(file, plan);
    if (!start) {
      throw InputError("{}: its fit has ended; make Gaussians anew without --resume",
                       file.string());
    }
  } else {
    const Config config = ConfigOf(field.config, request.assignments);
    splats = config.splats;
    plan.steps = splats.steps;
    plan.seconds_per_frame = request.seconds_per_frame;
    const auto gives_count = [](const std::string& assignment) {
      return assignment.starts_with("splats.count=");
    };
    if (request.megabytes > 0 && std::ranges::any_of(request.assignments, gives_count)) {
      throw InputError("--megabytes and --set splats.count both give the number; omit one");
    }
    if (request.megabytes > 0) splats.count = CountFor(request.megabytes, config);
  }
  const Dataset data =
      LoadPhotographs(sfm::ReadTransformsJson(PosesPath(request.run)), field.config,
                      field.scene.normalized_from_world, request.run, listener);
  const GaussianScene scene = GaussianSceneOf(field, splats, data, request.time_budget);
  const GaussianValidation validation(scene, data);
  if (!start) {
    WarnOfFieldsEffects(scene.config, listener);
    start = StartAtSurfaces(*run.model, scene, stop, [&](std::size_t done) {
      listener(SurfacesRendered{done, data.train.size()});
    });
  }
  if (!start) return std::nullopt;
  plan.file = file;
  plan.checkpoint_every = scene.config.train.checkpoint_every;
  if (request.time_budget > 0) {
    plan.seconds = std::max(kLeastFitSeconds, request.time_budget - watch.Seconds());
  }
  RepresentationRecord record = ReadRepresentation(request.run);
  const bool stood = record.splats_stand;
  plan.before_writing = [&] { ForgetReached(record, request.run); };
  GaussianSession session;
  session.fit = FitGaussians(scene, std::move(*start), &validation, plan, stop, listener).summary;
  if (!session.fit.finished) return session;
  if (validation.Empty()) {
    record.splats_stand = stood;
  } else {
    session.reached = ComparedPsnr{validation.Psnr(field), session.fit.psnr};
    record.reached = session.reached;
  }
  WriteRepresentation(record, request.run);
  return session;
}

}  // namespace nerf
