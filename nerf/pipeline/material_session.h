#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "nerf/base/stopwatch.h"
#include "nerf/config/material_options.h"
#include "nerf/light/environment_map.h"
#include "nerf/model/materials_file.h"
#include "nerf/pipeline/events.h"

namespace nerf {

// What `nerf materials` is asked for.
struct MaterialRequest {
  std::filesystem::path run;
  double time_budget = 0;     // seconds of the command; 0: by steps
  std::int64_t steps = 1000;  // of the fit, without a time budget
  MaterialOptions options;
  std::optional<EnvironmentMap> light;  // that shone on the scene; absent: it is found
  double light_exposure = 0;            // stops by which photographs show it brighter
};

struct MaterialSession {
  Materials materials;
  double psnr = 0;        // dB, of the pixels of the last steps, against their reflection
  bool finished = false;  // false: stopped on request; what was found till then is kept
};

// All of `nerf materials`: the surface of the field of a run, its shadows, and a fit of materials
// and light to the run's photographs. Writes RUN/materials.nerf and RUN/environment.exr.
//   returns  nullopt where it was stopped before the fit; nothing is written then
// Throws InputError where photographs differ in exposure or in encoding, or show no surface.
std::optional<MaterialSession> FindMaterials(const MaterialRequest& request, const Stopwatch& watch,
                                             const std::atomic<bool>& stop,
                                             const PipelineListener& listener);

}  // namespace nerf
