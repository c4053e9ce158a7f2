#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace nerf {

// Strict changes to a configuration as JSON: an unknown key is an error.

// Parses JSON. Throws InputError naming the byte of a syntax error.
//   where  names the file in errors
nlohmann::json ParseConfig(const std::string& text, const std::string& where);

// Converts "a.b=value" to {"a": {"b": value}}. The value is JSON; a bare word is a string.
// Throws InputError where there is no key or no "=".
nlohmann::json ParseAssignment(const std::string& assignment);

// Applies `change` to `base`; each key must exist in `base` with a value of the same kind. Optional
// blocks, as those of effects, are turned off by null and on by an object. Effects may have their
// old names.
//   where     names the file in errors
//   optional  these blocks with their defaults, by their keys: "effects.masks"
// Throws InputError naming the key.
void OverlayConfig(nlohmann::json& base, const nlohmann::json& change, const std::string& where,
                   const nlohmann::json& optional);

}  // namespace nerf
