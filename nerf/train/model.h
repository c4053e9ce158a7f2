#pragma once

#include <filesystem>
#include <memory>

#include "nerf/config.h"
#include "nerf/data/image.h"
#include "nerf/kernels/mlp.h"
#include "sfm/scene_normalization.h"

namespace nerf {

class Engine;
class OccupancyGrid;
class ProposalField;
class RadianceField;
struct Checkpoint;

// What a model must know of its scene, beside its parameters.
struct SceneFacts {
  ColorEncoding encoding = ColorEncoding::kSrgb;
  bool has_alpha = false;
  sfm::SceneNormalization normalized_from_world;
};

// A field with its occupancy grid, and the engine that evaluates them.
struct Model {
  Config config;
  SceneFacts scene;
  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  std::shared_ptr<ProposalField> proposal;  // where it and not the grid places the samples
  std::shared_ptr<Engine> engine;
};

// What config.train.precision says, "float" or "bfloat16".
kernels::Precision PrecisionOf(const Config& config);

// A new model; its parameters start from config.train.seed.
Model MakeModel(const Config& config, const SceneFacts& scene);

// The model's part of a checkpoint, and back.
void AddModel(const Model& model, Checkpoint& checkpoint);
Model ModelFromCheckpoint(const Checkpoint& checkpoint);

}  // namespace nerf
