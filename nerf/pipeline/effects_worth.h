#pragma once

#include <filesystem>

#include "nerf/model/run_folder.h"

namespace nerf {

// What each effect that a run simulates is worth and costs: short trainings in pairs, with all of
// them and without one, measured on the held-out photographs. Prints a table (or JSON) and writes
// it to effects_worth.json in `output`.
//   steps  of each training
// Throws InputError where the photographs are not there or none is held out.
void MeasureEffects(const OpenedRun& run, int steps, bool json,
                    const std::filesystem::path& output);

}  // namespace nerf
