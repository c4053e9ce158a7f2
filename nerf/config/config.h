#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "nerf/config/field_options.h"
#include "nerf/config/material_options.h"
#include "nerf/config/options_json.h"
#include "nerf/config/splat_options.h"
#include "nerf/config/train_options.h"
#include "nerf/effects/effects.h"
#include "nerf/kernels/hash_encoding.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/proposal_options.h"
#include "nerf/sampling/ray_marcher.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// The options of all modules, each block declared beside its algorithm. configs/base.json contains
// every key with its default; its blocks are named like the members here.
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
  SplatOptions splats;
  std::optional<MaterialOptions> materials;

  template <class Self, class Visitor>
  static void Options(Self& c, Visitor&& option) {
    option("data", c.data, "how photographs are read and split");
    option("encoding", c.encoding, "hash encoding of the field");
    option("field", c.field, "networks of the field");
    option("occupancy", c.occupancy, "occupancy grid");
    option("march", c.march, "sample placement along rays");
    option("proposal", c.proposal, "proposal network");
    option("loss", c.loss, "colour loss");
    option("effects", c.effects, "effects to simulate; null: off");
    option("gradient_scaling", c.gradient_scaling, "gradients near cameras");
    option("optimizer", c.optimizer, "Adam");
    option("schedule", c.schedule, "learning rate over the training");
    option("train", c.train, "length, batches, checkpoints");
    option("splats", c.splats, "Gaussians");
    option("materials", c.materials, "materials and light of the surface; null: off");
  }
};

// Of a time budget, the seconds for the field and for Gaussians, before materials.
double RadianceSeconds(const Config& config);

// The text of each configs/*.json by preset name, compiled into the program.
const std::map<std::string, std::string>& BuiltInPresets();

// Loads a preset or file and applies assignments to it.
//   preset       a built-in preset's name, or the path of a JSON file (which may name a "parent")
//   assignments  "block.key=value", value as JSON; applied in order
// Throws InputError naming the file and the key for an unknown key, a wrong type, or a value
// out of range.
Config LoadConfig(const std::string& preset, const std::vector<std::string>& assignments);

// The effects that the user has decided: those named by assignments, and those named by a JSON file
// or its parents. Includes kNearPlane where march.near_distance is given.
std::set<std::string> NamedEffects(const std::string& preset,
                                   const std::vector<std::string>& assignments);

// Whether the user has given a key, in the same way. Built-in presets do not count.
//   pointer  "/block/key"
bool GivesKey(const std::string& preset, const std::vector<std::string>& assignments,
              const std::string& pointer);

// The configuration with one effect turned on or off. An effect that is already on keeps its
// options.
Config WithEffect(Config config, const EffectDescriptor& effect, bool on);

// Every key with its default, unit, range and help, in the order of declaration.
std::vector<OptionHelp> ConfigHelp();
// The same as a Markdown table, as in docs/configuration.md.
std::string ConfigHelpTable();

// Converts a configuration to JSON and back; reading is as strict as LoadConfig.
//   where  names the file in errors
nlohmann::json JsonFromConfig(const Config& config);
Config ConfigFromJson(const nlohmann::json& json, const std::string& where);

}  // namespace nerf
