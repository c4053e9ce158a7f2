#pragma once

#include <array>
#include <string>
#include <vector>

#include "nerf/model/scene_facts.h"
#include "nerf/render/model_parts.h"

namespace nerf {

struct Checkpoint;

// A model: its modules, and what it knows of its scene. Engines and renderers borrow it.
struct Model : ModelParts {
  SceneFacts scene;
};

// A new model; its parameters start from config.train.seed.
// Throws InputError where an effect needs what the scene does not have.
Model MakeModel(const Config& config, const SceneFacts& scene);

// A deep copy, which shares nothing with the other.
Model CloneModel(const Model& model);

// What a photograph's exposure multiplies the field's colours by. Throws InputError where the model
// simulates no exposures or was not trained on a photograph of that name.
std::array<float, 3> GainsOf(const Model& model, const std::string& photograph);

// The model's part of a checkpoint, and back.
void AddModel(const Model& model, Checkpoint& checkpoint);
Model ModelFromCheckpoint(const Checkpoint& checkpoint);

}  // namespace nerf
