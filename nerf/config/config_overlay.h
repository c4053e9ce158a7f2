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

// Applies `change` to `base`; each key must exist in `base` with a value of the same kind. Below
// "effects", null turns an effect off, an object turns it on, and effects may have their old names.
//   where    names the file in errors
//   effects  the blocks of all effects with their defaults
// Throws InputError naming the key.
void OverlayConfig(nlohmann::json& base, const nlohmann::json& change, const std::string& where,
                   const nlohmann::json& effects);

}  // namespace nerf
