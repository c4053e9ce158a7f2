#include "nerf/pipeline/material_session.h"

#include <algorithm>

#include "nerf/base/input_error.h"
#include "nerf/model/materials_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/prepared_scene.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

// The least time for a surface and a fit, seconds.
constexpr double kLeastSeconds = 1;

// The photographs of a run, or others, all of them to be used.
PosedImages PosedFrom(const std::filesystem::path& photographs, const std::filesystem::path& run) {
  if (photographs.empty()) return sfm::ReadTransformsJson(PosesPath(run));
  PosedImages posed = sfm::ReadTransformsJson(photographs);
  for (PosedImage& image : posed.images) {
    if (image.split == Split::kUnspecified) image.split = Split::kTrain;
  }
  return posed;
}

}  // namespace

std::optional<MaterialsFound> FindMaterials(const MaterialRequest& request, const Stopwatch& watch,
                                            const std::atomic<bool>& stop,
                                            const PipelineListener& listener) {
  const OpenedRun run = OpenRun(request.run);
  const Config& config = run.model->GetConfig();
  RequireOneExposure(config);
  const std::filesystem::path file = MaterialsPath(request.run);
  std::filesystem::path photographs = request.photographs;
  if (request.resume) {
    const Materials begun = ReadMaterials(file);
    const auto interrupted = ReadInterruptedMaterials(file);
    if (!interrupted || begun.field_step != run.model->Step()) {
      throw InputError("{}: {}; find materials anew without --resume", file.string(),
                       interrupted ? "is of an earlier state of the field" : "its fit has ended");
    }
    photographs = interrupted->photographs;
  }
  const PosedImages posed = PosedFrom(photographs, request.run);
  const Dataset data = LoadPhotographs(posed, config, run.model->Scene().normalized_from_world,
                                       request.run, listener);
  MaterialPlan plan;
  plan.options = request.options;
  plan.lights = request.lights;
  plan.run = request.run;
  plan.resume = request.resume;
  if (!photographs.empty()) plan.photographs = std::filesystem::absolute(photographs).string();
  plan.checkpoint_every = config.train.checkpoint_every;
  if (request.time_budget > 0) {
    plan.seconds = std::max(kLeastSeconds, request.time_budget - watch.Seconds());
  }
  return TrainMaterials(*run.model, posed, data, plan, stop, listener);
}

}  // namespace nerf
