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

// The photographs of the request, all of them to be used where they are others than the run's.
PosedImages PosedOf(const MaterialRequest& request) {
  if (request.photographs.empty()) return sfm::ReadTransformsJson(PosesPath(request.run));
  PosedImages posed = sfm::ReadTransformsJson(request.photographs);
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
  if (request.resume && !ReadInterruptedMaterials(MaterialsPath(request.run))) {
    throw InputError("{}: its fit has ended; find materials anew without --resume",
                     MaterialsPath(request.run).string());
  }
  const PosedImages posed = PosedOf(request);
  const Dataset data = LoadPhotographs(posed, config, run.model->Scene().normalized_from_world,
                                       request.run, listener);
  MaterialPlan plan;
  plan.options = request.options;
  plan.lights = request.lights;
  plan.run = request.run;
  plan.resume = request.resume;
  plan.checkpoint_every = config.train.checkpoint_every;
  if (request.time_budget > 0) {
    plan.seconds = std::max(kLeastSeconds, request.time_budget - watch.Seconds());
  }
  return TrainMaterials(*run.model, posed, data, plan, stop, listener);
}

}  // namespace nerf
