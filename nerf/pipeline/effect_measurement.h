#pragma once

#include <functional>
#include <vector>

#include "nerf/effects/effect.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/events.h"
#include "nerf/pipeline/short_training.h"

namespace nerf {

// What an effect gains and costs.
struct EffectMeasurement {
  const EffectDescriptor* effect = nullptr;
  ShortTraining with, without;
  // Measured on halves of photographs whose other halves are trained on, and not on held-out
  // photographs (EffectDescriptor::measured_on_halves).
  bool on_halves = false;
};

// Measures each effect that a run simulates: short trainings in pairs, with all of its effects and
// without one, compared on the held-out photographs.
//   steps     of each training
//   progress  called with the number of trainings done, of how many, and the effect
// Throws InputError where the photographs are not there or none is held out.
std::vector<EffectMeasurement> MeasureEffects(
    const OpenedRun& run, int steps, const PipelineListener& listener,
    const std::function<void(std::size_t, std::size_t, const EffectDescriptor&)>& progress);

}  // namespace nerf
