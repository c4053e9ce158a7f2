#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nerf/effects/pose_refinement.h"
#include "nerf/image/image.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// What a model must know of its scene, beside its parameters.
struct SceneFacts {
  ColorEncoding encoding = ColorEncoding::kSrgb;
  bool has_alpha = false;
  SceneNormalization normalized_from_world;
  std::vector<std::string> photographs = {};  // that it is trained on, by name
  std::vector<CameraPlace> places = {};       // where they were taken, for pose refinement
  // Their exposures to begin with, log2 of light; empty: unknown. Not stored in checkpoints.
  std::vector<double> exposure_stops = {};
};

SceneFacts FactsOf(const Dataset& data, const SceneNormalization& normalized_from_world);

// As checkpoints hold them. Reading throws nlohmann::json::exception where a key is missing.
nlohmann::json JsonFromScene(const SceneFacts& scene);
SceneFacts SceneFromJson(const nlohmann::json& scene);

}  // namespace nerf
