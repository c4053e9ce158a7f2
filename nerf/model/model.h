#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/effects/poses_options.h"
#include "nerf/image/image.h"
#include "nerf/kernels/mlp.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

class Background;
class Engine;
class Exposure;
class OccupancyGrid;
class Poses;
class ProposalField;
class RadianceField;
struct Checkpoint;

// What a model must know of its scene, beside its parameters.
struct SceneFacts {
  ColorEncoding encoding = ColorEncoding::kSrgb;
  bool has_alpha = false;
  SceneNormalization normalized_from_world;
  std::vector<std::string> photographs = {};  // that it is trained on, by name
  std::vector<CameraPlace> places = {};       // where they were taken, for refinement of poses
  std::vector<double> exposure_stops = {};    // theirs, to begin with; empty: unknown. Not kept
};

SceneFacts FactsOf(const Dataset& data, const SceneNormalization& normalized_from_world);

// A field with its occupancy grid, and the engine that evaluates them.
struct Model {
  Config config;
  SceneFacts scene;
  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  std::shared_ptr<ProposalField> proposal;  // where it and not the grid places the samples
  std::shared_ptr<Background> background;   // where it is learned
  std::shared_ptr<Exposure> exposure;       // where photographs differ in it
  std::shared_ptr<Poses> poses;             // where they are refined
  std::shared_ptr<Engine> engine;
};

// What config.train.precision says, "float" or "bfloat16".
kernels::Precision PrecisionOf(const Config& config);

// A new model; its parameters start from config.train.seed.
Model MakeModel(const Config& config, const SceneFacts& scene);

// By what a photograph's exposure multiplies the field's colours. Throws InputError where the
// model simulates no exposures or was not trained on a photograph of that name.
std::array<float, 3> GainsOf(const Model& model, const std::string& photograph);

// The model's part of a checkpoint, and back.
void AddModel(const Model& model, Checkpoint& checkpoint);
Model ModelFromCheckpoint(const Checkpoint& checkpoint);

}  // namespace nerf
