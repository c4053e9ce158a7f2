#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nerf/effects/pose_refinement.h"
#include "nerf/image/image.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// The facts of a scene that a model needs beside its parameters.
struct SceneFacts {
  ColorEncoding encoding = ColorEncoding::kSrgb;
  bool has_alpha = false;
  SceneNormalization normalized_from_world;
  std::vector<std::string> photographs = {};  // names of the training photographs
  std::vector<CameraPlace> places = {};       // their cameras, for pose refinement
  // Their initial exposures, log2 of light; empty: unknown. Not stored in checkpoints.
  std::vector<double> exposure_stops = {};
};

SceneFacts FactsOf(const Dataset& data, const SceneNormalization& normalized_from_world);

// Conversion to the JSON of checkpoints and back. SceneFromJson throws nlohmann::json::exception if
// a key is missing.
nlohmann::json JsonFromScene(const SceneFacts& scene);
SceneFacts SceneFromJson(const nlohmann::json& scene);

}  // namespace nerf
