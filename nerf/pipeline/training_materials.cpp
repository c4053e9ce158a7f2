#include "nerf/pipeline/training_materials.h"

#include <algorithm>
#include <optional>

#include "nerf/base/atomic_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/material_training.h"
#include "nerf/pipeline/photograph_lights.h"

namespace nerf {
namespace {

// Where the training has taken longer than planned.
constexpr double kLeastSeconds = 1;

}  // namespace

void PrepareLights(const std::filesystem::path& lights, const PreparedScene& scene,
                   const std::filesystem::path& run) {
  constexpr int kAnyDirections = 16;
  std::optional<LightPlan> plan;
  if (!lights.empty()) plan = ReadLightPlan(lights);
  LightsOn(scene.posed, plan, scene.normalized_from_world, kAnyDirections);
  if (plan) {
    CopyLightPlan(lights, LightsPath(run));
  } else {
    RemoveAll(LightsPath(run));
  }
}

bool MaterialsAfterTraining(const Trainer& trainer, const PosedImages& posed, const Dataset& data,
                            const std::filesystem::path& run, const std::atomic<bool>& stop,
                            const PipelineListener& listener) {
  const Config& config = trainer.GetModel().config;
  MaterialPlan plan;
  plan.options = *config.materials;
  plan.run = run;
  plan.resume = true;
  plan.checkpoint_every = config.train.checkpoint_every;
  if (std::filesystem::exists(LightsPath(run))) plan.lights = ReadLightPlan(LightsPath(run));
  if (const double budget = config.train.time_budget; budget > 0) {
    // Of a resumed run, it is not known how long Gaussians took.
    const double share = config.materials->share * budget;
    plan.seconds = std::max(kLeastSeconds, std::min(share, budget - trainer.SpentSeconds()));
  }
  const auto field = ModelSnapshot::Copy(trainer.GetModel(), trainer.Steps());
  const std::optional<MaterialsFound> found =
      TrainMaterials(*field, posed, data, plan, stop, listener);
  if (found) listener(*found);
  return found && found->finished;
}

}  // namespace nerf
