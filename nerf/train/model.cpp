#include "nerf/train/model.h"

#include <cstring>

#include "nerf/field/radiance_field.h"
#include "nerf/field/tensor_span.h"
#include "nerf/train/checkpoint.h"
#include "nerf/train/libtorch_engine.h"
#include "sfm/input_error.h"

namespace nerf {
namespace {

using nlohmann::json;

constexpr char kFieldPrefix[] = "field.";
constexpr char kOccupancyName[] = "occupancy";

json JsonFromScene(const SceneFacts& scene) {
  const sfm::SceneNormalization& n = scene.normalized_from_world;
  json rotation = json::array(), translation = json::array();
  for (int i = 0; i < 9; ++i) rotation.push_back(n.rotation(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) translation.push_back(n.translation[i]);
  return {{"encoding", scene.encoding == ColorEncoding::kSrgb ? "srgb" : "linear"},
          {"has_alpha", scene.has_alpha},
          {"scale", n.scale},
          {"rotation", rotation},
          {"translation", translation}};
}

SceneFacts SceneFromJson(const json& scene) {
  SceneFacts facts;
  facts.encoding = scene.at("encoding") == "srgb" ? ColorEncoding::kSrgb : ColorEncoding::kLinear;
  facts.has_alpha = scene.at("has_alpha");
  sfm::SceneNormalization& n = facts.normalized_from_world;
  n.scale = scene.at("scale");
  for (int i = 0; i < 9; ++i) n.rotation(i / 3, i % 3) = scene.at("rotation").at(i);
  for (int i = 0; i < 3; ++i) n.translation[i] = scene.at("translation").at(i);
  return facts;
}

}  // namespace

Model MakeModel(const Config& config, const SceneFacts& scene) {
  Model model{config, scene, nullptr, nullptr, nullptr};
  model.field = std::make_shared<RadianceField>(config.encoding, config.field, scene.encoding,
                                                config.train.seed);
  model.grid = std::make_shared<OccupancyGrid>(config.occupancy, config.march.StepLength());
  model.engine = std::make_shared<LibTorchEngine>(model.field, model.grid, config.march,
                                                  config.loss, config.gradient_scaling);
  return model;
}

void AddModel(const Model& model, Checkpoint& checkpoint) {
  checkpoint.meta["config"] = JsonFromConfig(model.config);
  checkpoint.meta["scene"] = JsonFromScene(model.scene);
  checkpoint.meta["detail"] = model.field->Detail();
  for (const auto& parameter : model.field->named_parameters()) {
    checkpoint.tensors[kFieldPrefix + parameter.key()] = parameter.value();
  }
  const std::vector<float>& density = model.grid->Density();
  checkpoint.tensors[kOccupancyName] =
      TensorOf(density, {static_cast<std::int64_t>(density.size())}, torch::kFloat).clone();
}

Model ModelFromCheckpoint(const Checkpoint& checkpoint) {
  try {
    Model model = MakeModel(ConfigFromJson(checkpoint.meta.at("config"), "checkpoint"),
                            SceneFromJson(checkpoint.meta.at("scene")));
    for (const auto& parameter : model.field->named_parameters()) {
      CopyTensor(checkpoint.tensors, kFieldPrefix + parameter.key(), parameter.value());
    }
    model.field->SetDetail(checkpoint.meta.at("detail"));
    std::vector<float>& density = model.grid->Density();
    CopyTensor(checkpoint.tensors, kOccupancyName,
               torch::from_blob(density.data(), {static_cast<std::int64_t>(density.size())}));
    model.grid->Refresh();
    return model;
  } catch (const json::exception& error) {
    throw sfm::InputError("checkpoint: {}; train again", error.what());
  }
}

}  // namespace nerf
