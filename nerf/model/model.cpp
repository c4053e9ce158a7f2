#include "nerf/model/model.h"

#include <algorithm>
#include <cstring>

#include "nerf/base/input_error.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/poses.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/field/tensor_span.h"
#include "nerf/model/checkpoint.h"
#include "nerf/model/parameters.h"
#include "nerf/render/fused_engine.h"
#include "nerf/render/libtorch_engine.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {
namespace {

using nlohmann::json;

constexpr char kOccupancyName[] = "occupancy";

json JsonFromScene(const SceneFacts& scene) {
  const SceneNormalization& n = scene.normalized_from_world;
  json rotation = json::array(), translation = json::array();
  for (int i = 0; i < 9; ++i) rotation.push_back(n.rotation(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) translation.push_back(n.translation[i]);
  json places = json::array();
  for (const CameraPlace& p : scene.places) {
    places.push_back({{"centre", {p.centre.x(), p.centre.y(), p.centre.z()}},
                      {"axis", {p.axis.x(), p.axis.y(), p.axis.z()}},
                      {"lens", p.lens}});
  }
  return {{"encoding", scene.encoding == ColorEncoding::kSrgb ? "srgb" : "linear"},
          {"has_alpha", scene.has_alpha},
          {"scale", n.scale},
          {"rotation", rotation},
          {"translation", translation},
          {"photographs", scene.photographs},
          {"places", places}};
}

SceneFacts SceneFromJson(const json& scene) {
  SceneFacts facts;
  facts.encoding = scene.at("encoding") == "srgb" ? ColorEncoding::kSrgb : ColorEncoding::kLinear;
  facts.has_alpha = scene.at("has_alpha");
  facts.photographs = scene.value("photographs", std::vector<std::string>());
  for (const json& place : scene.value("places", json::array())) {
    CameraPlace p;
    for (int i = 0; i < 3; ++i) p.centre[i] = place.at("centre").at(i);
    for (int i = 0; i < 3; ++i) p.axis[i] = place.at("axis").at(i);
    p.lens = place.at("lens");
    facts.places.push_back(p);
  }
  SceneNormalization& n = facts.normalized_from_world;
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
      throw InputError("checkpoint: {} is not of the size that its configuration asks for", name);
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

SceneFacts FactsOf(const Dataset& data, const SceneNormalization& normalized_from_world) {
  SceneFacts facts = {data.encoding, data.has_alpha, normalized_from_world, {}, {}, {}};
  for (const View& view : data.train) {
    facts.photographs.push_back(view.name);
    facts.places.push_back({view.normalized_from_camera.translation(),
                            view.normalized_from_camera.linear().col(2), view.lens});
  }
  return facts;
}

kernels::Precision PrecisionOf(const Config& config) {
  return config.train.precision == "bfloat16" ? kernels::Precision::kBfloat16
                                              : kernels::Precision::kFloat;
}

Model MakeModel(const Config& config, const SceneFacts& scene) {
  Model model;
  model.config = config;
  model.scene = scene;
  model.field = std::make_shared<RadianceField>(config.encoding, config.field, scene.encoding,
                                                config.train.seed,
                                                ColorModelWith(config.effects.view.has_value()));
  model.grid = std::make_shared<OccupancyGrid>(config.occupancy, config.march.StepLength());
  if (UsesProposal(config.march, scene.has_alpha)) {
    model.proposal = std::make_shared<ProposalField>(config.proposal, config.train.seed);
  }
  if (config.effects.background) {
    if (scene.has_alpha) {
      throw InputError(
          "effects.background: photographs with alpha show no background to learn; set "
          "effects.background=null");
    }
    model.background = std::make_shared<Background>(*config.effects.background, scene.encoding);
  }
  if (config.effects.exposure) {
    model.exposure = std::make_shared<Exposure>(static_cast<std::int64_t>(scene.photographs.size()),
                                                scene.encoding);
    if (!scene.exposure_stops.empty()) model.exposure->Start(scene.exposure_stops);
  }
  if (config.effects.poses) {
    model.poses = std::make_shared<Poses>(scene.places, *config.effects.poses);
  } else {
    model.scene.places.clear();  // nobody asks for them
  }
  EngineParts parts;
  parts.field = model.field;
  parts.grid = model.grid;
  parts.proposal = model.proposal;
  parts.march = config.march;
  parts.proposal_options = config.proposal;
  parts.loss = config.loss;
  parts.gradient_scaling = config.gradient_scaling;
  parts.robust = config.effects.robust;
  parts.depth = config.effects.depth;
  parts.footprint = config.effects.footprint;
  parts.background = model.background;
  parts.exposure = model.exposure;
  parts.poses = model.poses;
  parts.precision = PrecisionOf(config);
  if (config.train.engine == "fused") {
    model.engine = std::make_shared<FusedEngine>(parts);
  } else {
    model.engine = std::make_shared<LibTorchEngine>(parts);
  }
  return model;
}

std::array<float, 3> GainsOf(const Model& model, const std::string& photograph) {
  if (!model.exposure) {
    throw InputError(
        "--exposure-of {}: the run simulates no exposures; train with --set effects.exposure={{}}",
        photograph);
  }
  const std::vector<std::string>& names = model.scene.photographs;
  const auto found = std::ranges::find(names, photograph);
  if (found == names.end()) {
    throw InputError("--exposure-of {}: not among the {} photographs of the training; one is {}",
                     photograph, names.size(), names.front());
  }
  const torch::NoGradGuard no_grad;
  const torch::Tensor gains = model.exposure->Gains()[found - names.begin()];
  return {gains[0].item<float>(), gains[1].item<float>(), gains[2].item<float>()};
}

std::vector<std::pair<std::string, torch::Tensor>> NamedParameters(const Model& model) {
  std::vector<std::pair<std::string, torch::Tensor>> named;
  const auto add = [&](const std::string& prefix, const torch::nn::Module& module) {
    for (const auto& parameter : module.named_parameters()) {
      named.emplace_back(prefix + parameter.key(), parameter.value());
    }
  };
  add("field.", *model.field);
  if (model.proposal) add("proposal.", *model.proposal);
  if (model.background) add("background.", *model.background);
  if (model.exposure) add("exposure.", *model.exposure);
  if (model.poses) add("poses.", *model.poses);
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
    throw InputError("checkpoint: {}; train again", error.what());
  }
}

}  // namespace nerf
