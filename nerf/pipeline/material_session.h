#pragma once

#include <atomic>
#include <filesystem>
#include <optional>

#include "nerf/base/stopwatch.h"
#include "nerf/pipeline/material_training.h"

namespace nerf {

// What `nerf materials` is asked for.
struct MaterialRequest {
  std::filesystem::path run;
  std::filesystem::path photographs;  // a transforms.json; empty: those of the run
  double time_budget = 0;             // seconds of the command; 0: by options.steps
  MaterialOptions options;
  std::optional<LightPlan> lights;
  bool resume = false;  // as it was planned; other members but `run` are ignored
};

// All of `nerf materials`: TrainMaterials of the field of a run, from its photographs, or from
// others that are posed in the same world.
//   returns  nullopt where it was stopped before the fit; nothing is written then
// Throws InputError as TrainMaterials does, and where there is nothing to resume.
std::optional<MaterialsFound> FindMaterials(const MaterialRequest& request, const Stopwatch& watch,
                                            const std::atomic<bool>& stop,
                                            const PipelineListener& listener);

}  // namespace nerf
