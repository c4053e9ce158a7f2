#pragma once

#include <filesystem>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/light/environment_map.h"
#include "nerf/light/light_name.h"

namespace nerf {

// The map in a file, or a uniform one with the colour of a named light. Throws InputError.
inline EnvironmentMap OpenEnvironment(const std::string& name) {
  if (!std::filesystem::exists(name)) {
    if (const auto color = ColorOfLight(name)) return EnvironmentMap::Uniform(*color);
    throw InputError("--environment {}: neither a file nor a named light; the names are {}", name,
                     kLightNames);
  }
  return EnvironmentMap::Read(name);
}

}  // namespace nerf
