#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "nerf/config/field_options.h"
#include "nerf/config/options_json.h"
#include "nerf/config/train_options.h"
#include "nerf/effects/effects.h"
#include "nerf/kernels/hash_encoding.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/proposal_options.h"
#include "nerf/sampling/ray_marcher.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// The options of every module, each declared beside its algorithm. configs/base.json holds each key
// with its default; the blocks there have the names of the members here.
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

  template <class Self, class Visitor>
  static void Options(Self& c, Visitor&& option) {
    option("data", c.data, "how photographs are read and split");
    option("encoding", c.encoding, "hash encoding of the field");
    option("field", c.field, "networks of the field");
    option("occupancy", c.occupancy, "grid of what may hold matter");
    option("march", c.march, "where samples may stand on a ray");
    option("proposal", c.proposal, "the network that places samples");
    option("loss", c.loss, "loss of colours");
    option("effects", c.effects, "what is simulated beyond the field; null: off");
    option("gradient_scaling", c.gradient_scaling, "gradients near cameras");
    option("optimizer", c.optimizer, "Adam");
    option("schedule", c.schedule, "learning rate over the training");
    option("train", c.train, "length, batches, checkpoints");
  }
};

// The texts of configs/*.json by preset name, compiled in.
const std::map<std::string, std::string>& BuiltInPresets();

// The configuration of a preset or file, changed by assignments.
//   preset       a built-in preset's name, or the path of a JSON file (which may name a "parent")
//   assignments  "block.key=value", value as JSON; applied in order
// Throws InputError naming the file and the key for an unknown key, a wrong type, or a value
// out of range.
Config LoadConfig(const std::string& preset, const std::vector<std::string>& assignments);

// The effects that the user's own configuration decides: those that assignments name, and those
// that a JSON file (or its parents) names.
std::set<std::string> NamedEffects(const std::string& preset,
                                   const std::vector<std::string>& assignments);

// The same configuration with one effect on or off; one that is on already keeps its options.
Config WithEffect(Config config, const EffectDescriptor& effect, bool on);

// Every key with its default, unit, range and help, in the order of declaration.
std::vector<OptionHelp> ConfigHelp();
// The same as a table in Markdown, as docs/configuration.md has it.
std::string ConfigHelpTable();

// A configuration as JSON and back; reading is as strict as LoadConfig.
//   where  names the file in errors
nlohmann::json JsonFromConfig(const Config& config);
Config ConfigFromJson(const nlohmann::json& json, const std::string& where);

}  // namespace nerf
