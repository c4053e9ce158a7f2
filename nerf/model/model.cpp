#include "nerf/model/model.h"

#include <algorithm>
#include <cstring>

#include "nerf/base/input_error.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/pose_refinement.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/field/tensor_span.h"
#include "nerf/model/checkpoint.h"
#include "nerf/model/parameters.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {
namespace {

constexpr char kOccupancyName[] = "occupancy";

// A malicious configuration could request tables of any size, so the sizes of the stored tensors
// are checked before anything is allocated.
void CheckSizes(const Config& config, bool with_proposal, const Checkpoint& checkpoint) {
  const auto check = [&](const std::string& name, std::int64_t numbers) {
    const auto found = checkpoint.tensors.find(name);
    if (found == checkpoint.tensors.end() || found->second.numel() != numbers) {
      throw InputError("checkpoint: the size of {} does not match its configuration", name);
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

Model MakeModel(const Config& config, const SceneFacts& scene) {
  Model model;
  model.config = config;
  model.scene = scene;
  model.field = std::make_shared<RadianceField>(
      config.encoding, config.field, scene.encoding, config.train.seed,
      ColorModelOf(config.effects.view_dependence.has_value()));
  model.grid = std::make_shared<OccupancyGrid>(config.occupancy, config.march.StepLength());
  if (UsesProposal(config.march, scene.has_alpha)) {
    model.proposal = std::make_shared<ProposalField>(config.proposal, config.train.seed);
  }
  if (config.effects.background) {
    if (scene.has_alpha) {
      throw InputError(
          "effects.background: photographs with alpha have no background to learn; set "
          "effects.background=null");
    }
    model.background = std::make_shared<Background>(*config.effects.background, scene.encoding);
  }
  if (config.effects.exposure) {
    model.exposure = std::make_shared<Exposure>(static_cast<std::int64_t>(scene.photographs.size()),
                                                scene.encoding);
    if (!scene.exposure_stops.empty()) model.exposure->Initialize(scene.exposure_stops);
  }
  if (config.effects.pose_refinement) {
    model.pose_refinement =
        std::make_shared<PoseRefinement>(scene.places, *config.effects.pose_refinement);
  } else {
    model.scene.places.clear();  // not needed
  }
  return model;
}

Model CloneModel(const Model& model) {
  Model clone = MakeModel(model.config, model.scene);
  clone.annealing = model.annealing;
  const torch::NoGradGuard no_grad;
  const auto from = NamedParameters(model), to = NamedParameters(clone);
  for (std::size_t i = 0; i < from.size(); ++i) torch::Tensor(to[i].second).copy_(from[i].second);
  clone.grid->Density() = model.grid->Density();
  clone.grid->Refresh();
  return clone;
}

std::array<float, 3> GainsOf(const Model& model, const std::string& photograph) {
  if (!model.exposure) {
    throw InputError(
        "--exposure-of {}: the run does not simulate exposures; train with --set "
        "effects.exposure={{}}",
        photograph);
  }
  const std::vector<std::string>& names = model.scene.photographs;
  const auto found = std::ranges::find(names, photograph);
  if (found == names.end()) {
    throw InputError("--exposure-of {}: not one of the {} training photographs, such as {}",
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
  if (model.background) add(kBackgroundEffect.parameters, *model.background);
  if (model.exposure) add(kExposureEffect.parameters, *model.exposure);
  if (model.pose_refinement) add(kPoseRefinementEffect.parameters, *model.pose_refinement);
  return named;
}

void AddModel(const Model& model, Checkpoint& checkpoint) {
  checkpoint.meta["config"] = JsonFromConfig(model.config);
  checkpoint.meta["scene"] = JsonFromScene(model.scene);
  checkpoint.meta["detail"] = model.annealing.detail;
  if (model.proposal) checkpoint.meta["trust"] = model.annealing.proposal;
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
    if (model.proposal) model.annealing.proposal = checkpoint.meta.at("trust");
    model.annealing.detail = checkpoint.meta.at("detail");
    std::vector<float>& density = model.grid->Density();
    CopyTensor(checkpoint.tensors, kOccupancyName,
               torch::from_blob(density.data(), {static_cast<std::int64_t>(density.size())}));
    model.grid->Refresh();
    return model;
  } catch (const nlohmann::json::exception& error) {
    throw InputError("checkpoint: {}; train again", error.what());
  }
}

}  // namespace nerf
