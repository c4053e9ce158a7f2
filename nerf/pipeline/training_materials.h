#pragma once

#include <atomic>
#include <filesystem>

#include "nerf/pipeline/events.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/train/trainer.h"

namespace nerf {

// The part of `nerf train --materials` that is about materials.

// Copies what is known of the lights to RUN/lights.json.
//   lights  a lights.json; empty: nothing beside what the capture says
// Throws InputError where the light on a photograph is not clear.
void PrepareLights(const std::filesystem::path& lights, const PreparedScene& scene,
                   const std::filesystem::path& run);

// TrainMaterials of a trained field, in what is left of its time budget; goes on where it was
// interrupted.
//   returns  false where it was stopped
bool MaterialsAfterTraining(const Trainer& trainer, const PosedImages& posed, const Dataset& data,
                            const std::filesystem::path& run, const std::atomic<bool>& stop,
                            const PipelineListener& listener);

}  // namespace nerf
