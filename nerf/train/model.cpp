#include "nerf/train/model.h"

#include <cstring>

#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/field/tensor_span.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/train/checkpoint.h"
#include "nerf/train/fused_engine.h"
#include "nerf/train/libtorch_engine.h"
#include "nerf/train/parameters.h"
#include "sfm/input_error.h"

namespace nerf {
namespace {

using nlohmann::json;

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

// A hostile file may ask for tables of any size: what is made must be what the file holds.
void CheckSizes(const Config& config, bool with_proposal, const Checkpoint& checkpoint) {
  const auto check = [&](const std::string& name, std::int64_t numbers) {
    const auto found = checkpoint.tensors.find(name);
    if (found == checkpoint.tensors.end() || found->second.numel() != numbers) {
      throw sfm::InputError("checkpoint: {} is not of the size that its configuration asks for",
                            name);
    }
  };
  const auto floats = [](const kernels::HashGridOptions& encoding) {
    const kernels::HashGridLayout layout = kernels::MakeHashGridLayout(encoding);
    return layout.entries * layout.features;
  };
  const std::int64_t resolution = config.occupancy.resolution;
  check("field.hash_encoding.table", floats(config.encoding));
  check(kOccupancyName, resolution * resolution * resolution);
  if (with_proposal) check("proposal.hash_encoding.table", floats(config.proposal.encoding));
}

}  // namespace

kernels::Precision PrecisionOf(const Config& config) {
  return config.train.precision == "bfloat16" ? kernels::Precision::kBfloat16
                                              : kernels::Precision::kFloat;
}

Model MakeModel(const Config& config, const SceneFacts& scene) {
  Model model;
  model.config = config;
  model.scene = scene;
  model.field = std::make_shared<RadianceField>(config.encoding, config.field, scene.encoding,
                                                config.train.seed);
  model.grid = std::make_shared<OccupancyGrid>(config.occupancy, config.march.StepLength());
  if (UsesProposal(config.march, scene.has_alpha)) {
    model.proposal = std::make_shared<ProposalField>(config.proposal, config.train.seed);
  }
  const EngineParts parts = {
      model.field,     model.grid,  model.proposal,          config.march,
      config.proposal, config.loss, config.gradient_scaling, PrecisionOf(config)};
  if (config.train.engine == "fused") {
    model.engine = std::make_shared<FusedEngine>(parts);
  } else {
    model.engine = std::make_shared<LibTorchEngine>(parts);
  }
  return model;
}

std::vector<std::pair<std::string, torch::Tensor>> NamedParameters(const Model& model) {
  std::vector<std::pair<std::string, torch::Tensor>> named;
  for (const auto& parameter : model.field->named_parameters()) {
    named.emplace_back("field." + parameter.key(), parameter.value());
  }
  if (model.proposal) {
    for (const auto& parameter : model.proposal->named_parameters()) {
      named.emplace_back("proposal." + parameter.key(), parameter.value());
    }
  }
  return named;
}

void AddModel(const Model& model, Checkpoint& checkpoint) {
  checkpoint.meta["config"] = JsonFromConfig(model.config);
  checkpoint.meta["scene"] = JsonFromScene(model.scene);
  checkpoint.meta["detail"] = model.field->Detail();
  if (model.proposal) checkpoint.meta["trust"] = model.proposal->Trust();
  for (const auto& [name, parameter] : NamedParameters(model)) {
    checkpoint.tensors[name] = parameter;
  }
  const std::vector<float>& density = model.grid->Density();
  checkpoint.tensors[kOccupancyName] =
      TensorOf(density, {static_cast<std::int64_t>(density.size())}, torch::kFloat).clone();
}

Model ModelFromCheckpoint(const Checkpoint& checkpoint) {
  try {
    const Config config = ConfigFromJson(checkpoint.meta.at("config"), "checkpoint");
    const SceneFacts scene = SceneFromJson(checkpoint.meta.at("scene"));
    CheckSizes(config, UsesProposal(config.march, scene.has_alpha), checkpoint);
    Model model = MakeModel(config, scene);
    for (const auto& [name, parameter] : NamedParameters(model)) {
      CopyTensor(checkpoint.tensors, name, parameter);
    }
    if (model.proposal) model.proposal->SetTrust(checkpoint.meta.at("trust"));
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
