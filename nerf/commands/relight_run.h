#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nerf/commands/shots.h"

namespace nerf {

// nerf relight RUN: what of the command's options is for runs.
struct RelightRunArguments {
  std::string run, output;
  std::vector<std::string> environments;  // files or named lights
  std::string lights;                     // a lights.json: all its lights, one after the other
  std::string edit;                       // an edits.json
  double rotate = 0;                      // degrees
  std::optional<double> exposure;
  int bounces = 2;
  bool shows_map = false;  // the map is behind the surface
  int turning_frames = 0;  // of a film in which the environment turns once; 0: none
  ShotOptions shots;
};

// Whether a path is a run, and not a light-stage capture.
bool IsRun(const std::string& path);

// Shows views of a run under other lights, by the materials that were found. Throws InputError.
void RelightRun(const RelightRunArguments& arguments);

}  // namespace nerf
