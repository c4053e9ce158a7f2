#include "nerf/config/config.h"

#include <algorithm>
#include <optional>
#include <set>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/config/config_overlay.h"

// What may be missing is null where it is.
namespace nlohmann {
template <class T>
struct adl_serializer<std::optional<T>> {
  static void to_json(json& j, const std::optional<T>& value) { value ? j = *value : j = nullptr; }
  static void from_json(const json& j, std::optional<T>& value) {
    value = j.is_null() ? std::nullopt : std::optional<T>(j.get<T>());
  }
};
}  // namespace nlohmann

namespace nerf {

using nlohmann::json;

// Effects without options.
void to_json(json& j, const ViewOptions&) { j = json::object(); }
void from_json(const json&, ViewOptions&) {}
void to_json(json& j, const ExposureOptions&) { j = json::object(); }
void from_json(const json&, ExposureOptions&) {}
void to_json(json& j, const UnboundedOptions&) { j = json::object(); }
void from_json(const json&, UnboundedOptions&) {}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PosesOptions, rate)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FootprintOptions, pixels)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BackgroundOptions, resolution)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MaskOptions, meaning)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RobustOptions, scale)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DepthOptions, share, weight, delta)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EffectsOptions, poses, unbounded, footprint, view, background,
                                   exposure, masks, robust, depth)

// Each options struct's keys, once, for reading and writing.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DataOptions, downscale, test_every, validation_images, memory_mb)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FieldOptions, hidden_width, geometry_features, color_layers)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OccupancyOptions, resolution, decay, threshold, warmup_steps,
                                   update_every, coarse_to_fine_steps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MarchOptions, sampler, near_distance, far_distance,
                                   steps_per_unit, stop_transmittance)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LossOptions, kind, huber_delta)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GradientScalingOptions, full_distance)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OptimizerOptions, learning_rate, beta1, beta2, epsilon,
                                   weight_decay)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScheduleOptions, warmup_steps, final_factor)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrainOptions, engine, precision, steps, time_budget, target_psnr,
                                   samples_per_batch, max_rays_per_batch, error_driven_share, seed,
                                   checkpoint_every, validate_every)
namespace kernels {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HashGridOptions, levels, features, log2_table_size,
                                   base_resolution, max_resolution)
}  // namespace kernels
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ProposalOptions, intervals, samples, padding, anneal_steps,
                                   loss_weight, distortion, hidden_width, encoding)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Config, data, encoding, field, occupancy, march, proposal, loss,
                                   effects, gradient_scaling, optimizer, schedule, train)

namespace {

constexpr char kParentKey[] = "parent";

// Every effect with its defaults, whether it is on or not.
const json& EffectsWithDefaults() {
  static const json all = [] {
    EffectsOptions effects;
    effects.poses.emplace();
    effects.unbounded.emplace();
    effects.footprint.emplace();
    effects.view.emplace();
    effects.background.emplace();
    effects.exposure.emplace();
    effects.masks.emplace();
    effects.robust.emplace();
    effects.depth.emplace();
    return json(effects);
  }();
  return all;
}

// Writes a preset or file, after the chain of its parents, over `config`.
void ApplyPreset(json& config, const std::string& preset, std::set<std::string> seen) {
  if (!seen.insert(preset).second) {
    throw InputError("config {}: is its own parent; break the circle", preset);
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
  OverlayConfig(config, change, where, EffectsWithDefaults());
}

void CheckEncoding(const std::string& block, const kernels::HashGridOptions& o) {
  if (o.levels < 1 || o.levels > 32) {
    throw InputError("config: {}.levels is {}; use 1 to 32", block, o.levels);
  }
  if (o.features != 1 && o.features != 2 && o.features != 4 && o.features != 8) {
    throw InputError("config: {}.features is {}; use 1, 2, 4 or 8", block, o.features);
  }
  if (o.log2_table_size < 8 || o.log2_table_size > 24) {
    throw InputError("config: {}.log2_table_size is {}; use 8 to 24", block, o.log2_table_size);
  }
  if (o.base_resolution < 1 || o.max_resolution < o.base_resolution || o.max_resolution > 65536) {
    throw InputError(
        "config: {}.base_resolution {} and max_resolution {} must satisfy "
        "1 <= base <= max <= 65536",
        block, o.base_resolution, o.max_resolution);
  }
}

Config Checked(const json& document, const std::string& where) {
  Config config;
  try {
    config = document.get<Config>();
  } catch (const json::exception& error) {
    throw InputError("{}: {}", where, error.what());
  }
  // A whole number that its option cannot hold comes back as another one.
  if (const json::array_t changes = json::diff(document, json(config)); !changes.empty()) {
    throw InputError("{}: {} is out of range", where, changes[0]["path"].get<std::string>());
  }
  config.march.unbounded = config.effects.unbounded.has_value();
  CheckEncoding("encoding", config.encoding);
  CheckEncoding("proposal.encoding", config.proposal.encoding);
  config.proposal.Check();
  config.data.Check();
  config.field.Check();
  config.occupancy.Check();
  config.march.Check();
  config.loss.Check();
  config.effects.Check();
  config.gradient_scaling.Check();
  config.optimizer.Check();
  config.schedule.Check();
  config.train.Check();
  return config;
}

}  // namespace

json JsonFromConfig(const Config& config) { return config; }

std::vector<std::string> EffectNames() {
  std::vector<std::string> names;
  for (const auto& [name, block] : EffectsWithDefaults().items()) names.push_back(name);
  return names;
}

std::set<std::string> NamedEffects(const std::string& preset,
                                   const std::vector<std::string>& assignments) {
  std::set<std::string> named;
  const auto take = [&](const json& change) {
    if (!change.is_object()) return;
    if (change.contains(json::json_pointer("/march/near_distance"))) named.insert("near");
    const json effects = change.value("effects", json());
    if (!effects.is_object()) return;
    for (const auto& [name, block] : effects.items()) named.insert(name);
  };
  for (const std::string& assignment : assignments) take(ParseAssignment(assignment));
  // Built-in presets leave effects to the scene.
  for (std::string file = preset; !BuiltInPresets().contains(file);) {
    const json change = ParseConfig(ReadWholeFile(file), "config " + file);
    take(change);
    if (!change.contains(kParentKey)) break;
    file = change[kParentKey];
  }
  return named;
}

Config ConfigFromJson(const json& document, const std::string& where) {
  json complete = Config();
  OverlayConfig(complete, document, where, EffectsWithDefaults());
  return Checked(complete, where);
}

Config LoadConfig(const std::string& preset, const std::vector<std::string>& assignments) {
  json document = Config();
  ApplyPreset(document, preset, {});
  for (const std::string& assignment : assignments) {
    OverlayConfig(document, ParseAssignment(assignment), "--set " + assignment,
                  EffectsWithDefaults());
  }
  return Checked(document, "config " + preset);
}

}  // namespace nerf
