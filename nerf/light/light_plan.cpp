#include "nerf/light/light_plan.h"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string_view>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/json_fields.h"
#include "nerf/light/light_name.h"
#include "nerf/light/units.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr char kUnknown[] = "unknown";
constexpr double kBrightest = 1e12;  // W / m^2, W, cd or lm: products stay finite in float

void RequireKnownKeys(const nlohmann::json& object, const JsonFields& fields,
                      std::initializer_list<std::string_view> known) {
  for (const auto& item : object.items()) {
    bool is_known = false;
    std::string names;
    for (const std::string_view name : known) {
      is_known |= item.key() == name;
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
    if (!is_known) throw InputError("{} is unknown; use {}", fields.Where(item.key()), names);
  }
}

// Three finite numbers; nullopt: the key is absent.
std::optional<Eigen::Vector3d> Vector(const JsonFields& fields, const char* key) {
  const nlohmann::json* value = fields.Array(key);
  if (value == nullptr) return std::nullopt;
  Eigen::Vector3d vector;
  bool is_valid = value->size() == 3;
  for (std::size_t k = 0; k < 3 && is_valid; ++k) {
    is_valid = (*value)[k].is_number();
    if (is_valid) vector[static_cast<int>(k)] = (*value)[k].get<double>();
  }
  if (!is_valid || !vector.allFinite()) {
    throw InputError("{} must be three finite numbers", fields.Where(key));
  }
  return vector;
}

// The name of a light, D65 by default.
std::string ColorName(const JsonFields& fields) {
  const std::string name = fields.String("color").value_or("D65");
  if (!SpectrumOfLight(name)) {
    throw InputError("{}: there is no light {}; the names are {}", fields.Where("color"), name,
                     kLightNames);
  }
  return name;
}

DirectionalLight SunFrom(const nlohmann::json& json, const std::string& where) {
  const JsonFields fields(json, where);
  RequireKnownKeys(json, fields, {"direction", "irradiance", "color"});
  const auto direction = Vector(fields, "direction");
  if (!direction || direction->isZero()) {
    throw InputError("{} is missing; give the direction towards the light, [x, y, z]",
                     fields.Where("direction"));
  }
  DirectionalLight sun;
  sun.to_light = direction->stableNormalized();
  if (json.contains("irradiance") && json["irradiance"].is_array()) {
    sun.irradiance = Vector(fields, "irradiance")->array();
  } else {
    sun.irradiance = Color::Constant(fields.Number("irradiance").value_or(std::numbers::pi));
  }
  if ((sun.irradiance < 0).any() || (sun.irradiance > kBrightest).any()) {
    throw InputError("{} must be 0 to {}", fields.Where("irradiance"), kBrightest);
  }
  sun.irradiance *= *ColorOfLight(ColorName(fields));
  return sun;
}

PointLight PointFrom(const nlohmann::json& json, const std::string& where) {
  const JsonFields fields(json, where);
  RequireKnownKeys(json, fields, {"position", "watts", "candela", "lumens", "color"});
  const auto position = Vector(fields, "position");
  if (!position) throw InputError("{} is missing", fields.Where("position"));
  const std::string color = ColorName(fields);
  const Spectrum spectrum = *SpectrumOfLight(color);
  std::optional<double> watts;
  for (const char* unit : {"watts", "candela", "lumens"}) {
    const auto value = fields.Number(unit);
    if (!value) continue;
    if (watts) throw InputError("{}: give one of watts, candela and lumens", fields.Where(unit));
    if (*value < 0 || *value > kBrightest) {
      throw InputError("{} must be 0 to {}", fields.Where(unit), kBrightest);
    }
    watts = std::string_view(unit) == "watts" ? *value
            : std::string_view(unit) == "candela"
                ? WattsFromLumens(LumensFromCandela(*value), spectrum)
                : WattsFromLumens(*value, spectrum);
  }
  if (!watts) {
    throw InputError("{} is missing; give watts, candela or lumens", fields.Where("watts"));
  }
  return {*position, *watts / (4 * std::numbers::pi) * *ColorOfLight(color)};
}

// Calls add(element, where) for a list that may be absent.
template <class Add>
void ForEach(const JsonFields& fields, const char* key, const Add& add) {
  const nlohmann::json* list = fields.Array(key);
  if (list == nullptr) return;
  for (std::size_t i = 0; i < list->size(); ++i) {
    add((*list)[i], fmt::format("{}[{}].", fields.Where(key), i));
  }
}

PlannedLight LightFrom(const std::string& name, const nlohmann::json& json,
                       const std::string& where, const fs::path& folder) {
  const JsonFields fields(json, where);
  RequireKnownKeys(json, fields, {"environment", "rotate", "exposure", "suns", "points"});
  if (name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos) {
    throw InputError("{} is no name for a light, which names a folder; use letters",
                     where.substr(0, where.size() - 1));
  }
  PlannedLight light;
  light.name = name;
  light.rotate = fields.Number("rotate").value_or(0);
  light.exposure = fields.Number("exposure").value_or(0);
  constexpr double kMostStops = 64;
  if (std::abs(light.exposure) > kMostStops) {
    throw InputError("{} is {} stops; use -64 to 64", fields.Where("exposure"), light.exposure);
  }
  if (const auto environment = fields.String("environment")) {
    light.has_unknown_environment = *environment == kUnknown;
    if (!light.has_unknown_environment) {
      const auto color = ColorOfLight(*environment);
      light.environment =
          color ? EnvironmentMap::Uniform(*color) : EnvironmentMap::Read(folder / *environment);
    }
  }
  ForEach(fields, "suns", [&](const nlohmann::json& sun, const std::string& at) {
    light.suns.push_back(SunFrom(sun, at));
  });
  ForEach(fields, "points", [&](const nlohmann::json& point, const std::string& at) {
    light.points.push_back(PointFrom(point, at));
  });
  const bool is_dark = !light.environment && !light.has_unknown_environment;
  if (is_dark && light.suns.empty() && light.points.empty()) {
    throw InputError("{}: there is no light; give an environment, suns or points",
                     where.substr(0, where.size() - 1));
  }
  return light;
}

}  // namespace

std::optional<int> LightPlan::Find(const std::string& name) const {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

LightPlan ReadLightPlan(const fs::path& file) {
  const nlohmann::json root = ReadJsonFile(file);
  const JsonFields fields(root, file.string() + ": ");
  RequireKnownKeys(root, fields, {"lights", "photographs"});
  LightPlan plan;
  if (!root.contains("lights") || !root["lights"].is_object() || root["lights"].empty()) {
    throw InputError("{} is missing; give at least one light", fields.Where("lights"));
  }
  for (const auto& item : root["lights"].items()) {
    plan.lights.push_back(LightFrom(item.key(), item.value(),
                                    fmt::format("{}.{}.", fields.Where("lights"), item.key()),
                                    file.parent_path()));
  }
  if (!fields.Has("photographs")) return plan;
  const JsonFields photographs(root["photographs"], fields.Where("photographs") + ".");
  for (const auto& item : root["photographs"].items()) {
    const std::string name = photographs.String(item.key()).value_or("");
    const auto light = plan.Find(name);
    if (!light) {
      throw InputError("{}: there is no light '{}' in lights", photographs.Where(item.key()), name);
    }
    plan.photographs.emplace_back(item.key(), *light);
  }
  return plan;
}

void CopyLightPlan(const fs::path& from, const fs::path& to) {
  nlohmann::json root = ReadJsonFile(from);
  for (auto& item : root.at("lights").items()) {
    nlohmann::json& light = item.value();
    if (!light.contains("environment") || !light["environment"].is_string()) continue;
    const std::string environment = light["environment"];
    if (environment == kUnknown || ColorOfLight(environment)) continue;
    light["environment"] =
        fs::absolute(from.parent_path() / environment).lexically_normal().generic_string();
  }
  WriteFileAtomically(to, root.dump(2) + "\n");
}

}  // namespace nerf
