#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "nerf/light/light_plan.h"
#include "nerf/model/snapshot.h"
#include "nerf/pipeline/events.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// How materials of a field are found.
struct MaterialPlan {
  MaterialOptions options;
  std::optional<LightPlan> lights;    // absent: as the capture says (LightsOn)
  double seconds = 0;                 // of all of it; 0: by options.steps
  std::int64_t checkpoint_every = 0;  // steps; 0: only at the end
  std::filesystem::path run;          // RUN/materials.nerf, and a map of each light
  std::string photographs = {};       // the transforms.json of `posed`; empty: that of the run
  // Go on with RUN/materials.nerf, where it is of this field, as it was planned then.
  bool resume = false;
};

// Takes a field apart: its surface, the materials of the surface, and the lights on it, from the
// photographs of a capture. Writes RUN/materials.nerf, also where it is stopped, with what going on
// needs; by steps, the result is the same bits, whether it was interrupted or not.
//   posed  of which the photographs of `data` are
//   returns  nullopt where it was stopped before the fit; nothing is written then
// Throws InputError where photographs differ in exposure, show no surface, or where their light is
// not clear.
std::optional<MaterialsFound> TrainMaterials(const ModelSnapshot& field, const PosedImages& posed,
                                             const Dataset& data, const MaterialPlan& plan,
                                             const std::atomic<bool>& stop,
                                             const PipelineListener& listener);

// Throws InputError where materials cannot be found: photographs differ in exposure, or in kind.
void RequireOneExposure(const Config& config);
void RequireOneEncoding(const Dataset& data);

}  // namespace nerf
