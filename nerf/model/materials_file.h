#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nerf/config/material_options.h"
#include "nerf/relight/relightable_surface.h"

namespace nerf {

// The materials of a run: RUN/materials.nerf.
struct Materials {
  RelightableSurface surface;   // without edits
  MaterialOptions options;      // with which they were found
  int resolution = 0;           // of the material field, see MaterialField
  std::int64_t steps = 0;       // of the fit
  double seconds = 0;           // of the fit
  std::int64_t field_step = 0;  // of the field whose surface it is
};

// What going on needs with a fit that has not ended.
struct InterruptedMaterials {
  std::map<std::string, torch::Tensor> state;  // MaterialFit::AddTo
  // Its plan: the seconds of the whole fit, or where these are 0 its steps.
  double planned_seconds = 0;
  std::int64_t planned_steps = 0;
  // The lights on photographs, as they were planned: which of the lights are known, and the light
  // of each photograph by its name.
  std::vector<bool> is_known;
  std::map<std::string, std::int64_t> light_of;
  std::string photographs;  // the transforms.json of other photographs; empty: those of the run
};

// The mesh is not stored: it is where the distance is 0.
//   fit  where it has not ended
void WriteMaterials(const Materials& materials, const std::filesystem::path& file,
                    const InterruptedMaterials* fit = nullptr);

// Throws InputError naming a file that is missing, damaged, or none of materials.
Materials ReadMaterials(const std::filesystem::path& file);
// The fit that made a file, to go on with; nullopt where it has ended.
std::optional<InterruptedMaterials> ReadInterruptedMaterials(const std::filesystem::path& file);

}  // namespace nerf
