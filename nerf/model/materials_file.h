#pragma once

#include <cstdint>
#include <filesystem>

#include "nerf/config/material_options.h"
#include "nerf/relight/relightable_surface.h"

namespace nerf {

// The materials of a run: RUN/materials.nerf.
struct Materials {
  RelightableSurface surface;
  MaterialOptions options;      // with which they were found
  int resolution = 0;           // of the material field, see MaterialField
  std::int64_t steps = 0;       // of the fit
  std::int64_t field_step = 0;  // of the field whose surface it is
};

// The mesh is not stored: it is where the distance is 0.
void WriteMaterials(const Materials& materials, const std::filesystem::path& file);

// Throws InputError naming a file that is missing, damaged, or none of materials.
Materials ReadMaterials(const std::filesystem::path& file);

}  // namespace nerf
