#include "nerf/config/config_overlay.h"

#include <cstdint>
#include <string_view>

#include "nerf/base/input_error.h"
#include "nerf/effects/effects.h"

namespace nerf {

using nlohmann::json;

namespace {

// An integer is accepted for a real number, but not the other way round.
bool SameKind(const json& base, const json& value) {
  if (base.is_number_float()) return value.is_number();
  if (base.is_number_integer()) {  // no integer option is negative
    return value.is_number_unsigned() ||
           (value.is_number_integer() && value.get<std::int64_t>() >= 0);
  }
  return base.type() == value.type();
}

const char* KindName(const json& base) {
  if (base.is_number_float()) return "a number";
  if (base.is_number_integer()) return "a whole number, 0 or more";
  return base.type_name();
}

constexpr std::string_view kEffectsBlock = "effects";

std::string CurrentEffectName(const std::string& name) {
  const EffectDescriptor* const effect = FindEffect(name);
  return effect != nullptr ? effect->name : name;
}

std::string JoinKeys(const json& object) {
  std::string keys;
  for (const auto& [key, value] : object.items()) keys += (keys.empty() ? "" : ", ") + key;
  return keys;
}

void Overlay(json& base, const json& change, const std::string& where, const std::string& prefix,
             const json& optional);

// An optional block: null turns it off, an object turns it on and sets the keys it contains.
void OverlayOptional(json& block, const std::string& key, const json& change,
                     const std::string& where, const json& optional) {
  if (change.is_null()) {
    block = nullptr;
    return;
  }
  if (block.is_null()) block = optional.at(key);
  Overlay(block, change, where, key, optional);
}

// Applies `change` to `base`; each key must exist in `base` with a value of the same kind.
void Overlay(json& base, const json& change, const std::string& where, const std::string& prefix,
             const json& optional) {
  if (!change.is_object()) {
    throw InputError("{}: {} must be an object {{...}}", where,
                     prefix.empty() ? "the configuration" : prefix);
  }
  for (const auto& [given, value] : change.items()) {
    const std::string key = prefix == kEffectsBlock ? CurrentEffectName(given) : given;
    const std::string full = prefix.empty() ? key : prefix + "." + key;
    if (!base.contains(key)) {
      throw InputError("{}: unknown key {}; known here are {}", where, full, JoinKeys(base));
    }
    json& old = base[key];
    if (optional.contains(full)) {
      OverlayOptional(old, full, value, where, optional);
    } else if (old.is_object()) {
      Overlay(old, value, where, full, optional);
    } else if (!SameKind(old, value)) {
      throw InputError("{}: {} must be {}, not {}", where, full, KindName(old),
                       value.dump(-1, ' ', false, json::error_handler_t::replace));
    } else {
      old = value;
    }
  }
}

}  // namespace

json ParseConfig(const std::string& text, const std::string& where) {
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    throw InputError("{}: is not valid JSON at byte {}; fix it there", where, error.byte);
  } catch (const json::out_of_range& error) {
    throw InputError("{}: contains a number out of range: {}", where, error.what());
  }
}

json ParseAssignment(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--set {}: must be block.key=value, for example train.steps=2000", assignment);
  }
  const std::string text = assignment.substr(equals + 1);
  json value = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (value.is_discarded()) value = text;  // a bare word is a string
  std::string path = assignment.substr(0, equals);
  for (std::size_t dot; (dot = path.rfind('.')) != std::string::npos; path.resize(dot)) {
    value = json{{path.substr(dot + 1), value}};
  }
  return json{{path, value}};
}

void OverlayConfig(json& base, const json& change, const std::string& where, const json& optional) {
  Overlay(base, change, where, "", optional);
}

}  // namespace nerf
