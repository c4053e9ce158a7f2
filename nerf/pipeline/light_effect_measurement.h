#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nerf/model/materials_file.h"
#include "nerf/model/run_folder.h"

namespace nerf {

// What an effect of light is worth in views under the light of the photographs.
struct LightEffectMeasurement {
  std::string effect;       // shadows, bounces or specular
  double psnr_without = 0;  // dB, mean over the held-out photographs
  double seconds_with = 0;  // of a view and its share of the light
  double seconds_without = 0;
};

struct LightEffectMeasurements {
  double psnr = 0;  // dB, with all that the run simulates
  std::vector<LightEffectMeasurement> effects;
};

// Relights the held-out photographs with the light under which they were taken, with all effects
// that the materials of a run simulate, and with each turned off; materials stay as they are.
//   progress  called with the views done, and how many there are
// Throws InputError if no photograph is held out, or none can be read.
LightEffectMeasurements MeasureLightEffects(
    const OpenedRun& run, const Materials& materials,
    const std::function<void(std::size_t done, std::size_t of)>& progress);

}  // namespace nerf
