#pragma once

#include <optional>
#include <string>

#include "nerf/commands/shots.h"
#include "nerf/light/environment_map.h"

namespace nerf {

// nerf relight RUN: what of the command's options is for runs.
struct RelightRunArguments {
  std::string run, output;
  std::string environment;  // as given
  double rotate = 0;        // degrees
  std::optional<double> exposure;
  int bounces = 2;
  ShotOptions shots;
};

// Whether a path is a run, and not a light-stage capture.
bool IsRun(const std::string& path);

// Shows views of a run under an environment, by the materials that nerf materials found. Throws
// InputError.
void RelightRun(const RelightRunArguments& arguments, const EnvironmentMap& map);

}  // namespace nerf
