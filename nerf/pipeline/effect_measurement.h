#pragma once

#include <functional>
#include <vector>

#include "nerf/effects/effect.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/events.h"
#include "nerf/pipeline/short_training.h"

namespace nerf {

// The gain and the cost of an effect.
struct EffectMeasurement {
  const EffectDescriptor* effect = nullptr;
  ShortTraining with, without;
  // Measured on the right halves of photographs whose left halves are trained on, instead of
  // held-out photographs (EffectDescriptor::measured_on_halves).
  bool on_halves = false;
};

// Measures each effect that a run simulates by paired short trainings, with all effects of the run
// and with one turned off, compared on the held-out photographs.
//   steps     of each training
//   progress  called with the number of finished trainings, their total, and the effect
// Throws InputError if photographs are missing or none is held out.
std::vector<EffectMeasurement> MeasureEffects(
    const OpenedRun& run, int steps, const PipelineListener& listener,
    const std::function<void(std::size_t, std::size_t, const EffectDescriptor&)>& progress);

}  // namespace nerf
