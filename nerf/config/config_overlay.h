#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace nerf {

// How a configuration is changed as JSON: strictly, so that a key which nobody reads is an error.

// Throws InputError naming the byte where it is no JSON.
//   where  names the file in errors
nlohmann::json ParseConfig(const std::string& text, const std::string& where);

// "a.b=value" as {"a": {"b": value}}; value as JSON, a bare word is a string.
nlohmann::json ParseAssignment(const std::string& assignment);

// Writes `change` over `base`; each key must stand in `base` with the same kind of value. Below
// "effects" null turns an effect off, an object turns it on, and effects may be called by the names
// that they had a version ago.
//   where    names the file in errors
//   effects  every effect's block with its defaults
// Throws InputError naming the key.
void OverlayConfig(nlohmann::json& base, const nlohmann::json& change, const std::string& where,
                   const nlohmann::json& effects);

}  // namespace nerf
