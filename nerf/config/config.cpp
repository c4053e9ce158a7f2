#include "nerf/config/config.h"

#include <algorithm>
#include <set>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/config/config_overlay.h"
#include "nerf/effects/near_plane.h"

namespace nerf {

using nlohmann::json;

namespace {

constexpr char kParentKey[] = "parent";

// The optional blocks with their defaults, by their keys.
const json& OptionalBlocks() {
  static const json blocks = [] {
    EffectsOptions effects;
    EffectsOptions::VisitEffects(effects,
                                 [](const EffectDescriptor&, auto& block) { block.emplace(); });
    json all = {{"materials", JsonFromOptions(MaterialOptions())}};
    const json of_effects = JsonFromOptions(effects);
    for (const auto& item : of_effects.items()) all["effects." + item.key()] = item.value();
    return all;
  }();
  return blocks;
}

// Applies the parents of a preset or file, the outermost first, and then itself to `config`.
void ApplyPreset(json& config, const std::string& preset, std::set<std::string> seen) {
  if (!seen.insert(preset).second) {
    throw InputError("config {}: is its own parent; remove the cycle", preset);
  }
  const auto& built_in = BuiltInPresets();
  const auto found = built_in.find(preset);
  if (found == built_in.end() && !std::filesystem::exists(preset)) {
    std::string names;
    for (const auto& [name, text] : built_in) names += (names.empty() ? "" : ", ") + name;
    throw InputError("config {}: is neither a file nor a preset; presets are {}", preset, names);
  }
  const std::string where = "config " + preset;
  json change = ParseConfig(found != built_in.end() ? found->second : ReadWholeFile(preset), where);
  if (change.is_object() && change.contains(kParentKey)) {
    if (!change[kParentKey].is_string()) throw InputError("{}: parent must be a name", where);
    ApplyPreset(config, change[kParentKey], seen);
    change.erase(kParentKey);
  }
  OverlayConfig(config, change, where, OptionalBlocks());
}

void CheckEncoding(const std::string& block, const kernels::HashGridOptions& o) {
  if (o.base_resolution <= o.max_resolution) return;
  throw InputError("config: {}.base_resolution {} is above max_resolution {}; use a smaller one",
                   block, o.base_resolution, o.max_resolution);
}

// "encoding.levels" from "/encoding/levels".
std::string KeyFromPointer(std::string pointer) {
  std::ranges::replace(pointer, '/', '.');
  return pointer.substr(1);
}

// What the user wrote: the assignments, and the JSON files from `preset` up to a built-in preset.
std::vector<json> UserChanges(const std::string& preset,
                              const std::vector<std::string>& assignments) {
  std::vector<json> changes;
  for (const std::string& assignment : assignments) changes.push_back(ParseAssignment(assignment));
  for (std::string file = preset; !BuiltInPresets().contains(file);) {
    changes.push_back(ParseConfig(ReadWholeFile(file), "config " + file));
    if (!changes.back().contains(kParentKey)) break;
    file = changes.back()[kParentKey];
  }
  std::erase_if(changes, [](const json& change) { return !change.is_object(); });
  return changes;
}

Config Checked(const json& document, const std::string& where) {
  Config config;
  try {
    OptionsFromJson(document, "", config);
  } catch (const json::exception& error) {
    throw InputError("{}: {}", where, error.what());
  }
  // An integer that overflows its option's type changes in a round trip.
  if (const json::array_t changes = json::diff(document, JsonFromConfig(config));
      !changes.empty()) {
    throw InputError("{}: {} is out of range", where, KeyFromPointer(changes[0]["path"]));
  }
  config.march.unbounded = config.effects.unbounded.has_value();
  CheckRanges(config, "");
  CheckEncoding("encoding", config.encoding);
  CheckEncoding("proposal.encoding", config.proposal.encoding);
  config.march.Check();
  config.train.Check();
  return config;
}

}  // namespace

double RadianceSeconds(const Config& config) {
  return (config.materials ? 1 - config.materials->share : 1) * config.train.time_budget;
}

json JsonFromConfig(const Config& config) { return JsonFromOptions(config); }

std::vector<OptionHelp> ConfigHelp() {
  std::vector<OptionHelp> table;
  DescribeOptions(Config(), "", table);
  return table;
}

std::string ConfigHelpTable() {
  std::string table = "| key | default | unit | values | meaning |\n|---|---|---|---|---|\n";
  for (const OptionHelp& option : ConfigHelp()) {
    table += fmt::format("| `{}` | {} | {} | {} | {} |\n", option.key, option.value, option.unit,
                         option.range, option.help);
  }
  return table;
}

Config WithEffect(Config config, const EffectDescriptor& effect, bool on) {
  EffectsOptions::VisitEffects(config.effects, [&](const EffectDescriptor& other, auto& block) {
    if (&other != &effect || block.has_value() == on) return;
    block.reset();
    if (on) block.emplace();
  });
  config.march.unbounded = config.effects.unbounded.has_value();
  return config;
}

std::set<std::string> NamedEffects(const std::string& preset,
                                   const std::vector<std::string>& assignments) {
  std::set<std::string> named;
  for (const json& change : UserChanges(preset, assignments)) {
    if (change.contains(json::json_pointer("/march/near_distance"))) named.insert(kNearPlane);
    const json effects = change.value("effects", json());
    if (!effects.is_object()) continue;
    for (const auto& [name, block] : effects.items()) {
      const EffectDescriptor* const effect = FindEffect(name);
      named.insert(effect != nullptr ? effect->name : name);
    }
  }
  return named;
}

bool GivesKey(const std::string& preset, const std::vector<std::string>& assignments,
              const std::string& pointer) {
  const json::json_pointer key(pointer);
  return std::ranges::any_of(UserChanges(preset, assignments),
                             [&](const json& change) { return change.contains(key); });
}

Config ConfigFromJson(const json& document, const std::string& where) {
  json complete = JsonFromConfig(Config());
  OverlayConfig(complete, document, where, OptionalBlocks());
  return Checked(complete, where);
}

Config LoadConfig(const std::string& preset, const std::vector<std::string>& assignments) {
  json document = JsonFromConfig(Config());
  ApplyPreset(document, preset, {});
  for (const std::string& assignment : assignments) {
    OverlayConfig(document, ParseAssignment(assignment), "--set " + assignment, OptionalBlocks());
  }
  return Checked(document, "config " + preset);
}

}  // namespace nerf
