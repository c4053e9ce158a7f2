#pragma once

#include <array>
#include <string>
#include <vector>

#include "nerf/model/scene_facts.h"
#include "nerf/render/model_parts.h"

namespace nerf {

struct Checkpoint;

// A model: its modules and the facts of its scene. Engines and renderers keep references to it.
struct Model : ModelParts {
  SceneFacts scene;
};

// Creates a model, initialized from config.train.seed.
// Throws InputError if an effect does not fit the scene.
Model MakeModel(const Config& config, const SceneFacts& scene);

// A deep copy.
Model CloneModel(const Model& model);

// The gains of a training photograph's exposure, by channel. Throws InputError if the model does
// not simulate exposures or was not trained on a photograph of that name.
std::array<float, 3> GainsOf(const Model& model, const std::string& photograph);

// Writes the model to a checkpoint, and reads it back. Throws InputError if the checkpoint is
// incomplete or inconsistent.
void AddModel(const Model& model, Checkpoint& checkpoint);
Model ModelFromCheckpoint(const Checkpoint& checkpoint);

}  // namespace nerf
