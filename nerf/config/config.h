#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "nerf/config/field_options.h"
#include "nerf/config/train_options.h"
#include "nerf/effects/effects.h"
#include "nerf/kernels/hash_encoding.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/proposal_options.h"
#include "nerf/sampling/ray_marcher.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// The options of every module. configs/base.json holds each key with its default; the blocks there
// have the names of the members here.
struct Config {
  DataOptions data;
  kernels::HashGridOptions encoding;
  FieldOptions field;
  OccupancyOptions occupancy;
  MarchOptions march;
  ProposalOptions proposal;
  LossOptions loss;
  EffectsOptions effects;
  GradientScalingOptions gradient_scaling;
  OptimizerOptions optimizer;
  ScheduleOptions schedule;
  TrainOptions train;
};

// The texts of configs/*.json by preset name, compiled in.
const std::map<std::string, std::string>& BuiltInPresets();

// The configuration of a preset or file, changed by assignments.
//   preset       a built-in preset's name, or the path of a JSON file (which may name a "parent")
//   assignments  "block.key=value", value as JSON; applied in order
// Throws InputError naming the file and the key for an unknown key, a wrong type, or a value
// out of range.
Config LoadConfig(const std::string& preset, const std::vector<std::string>& assignments);

// The effects that a person's own configuration decides: those that assignments name, and those
// that a JSON file (or its parents) names.
std::set<std::string> NamedEffects(const std::string& preset,
                                   const std::vector<std::string>& assignments);

// The keys of all effects.
std::vector<std::string> EffectNames();

// A configuration as JSON and back; reading is as strict as LoadConfig.
//   where  names the file in errors
nlohmann::json JsonFromConfig(const Config& config);
Config ConfigFromJson(const nlohmann::json& json, const std::string& where);

}  // namespace nerf
