#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nerf/light/environment_map.h"
#include "nerf/light/lights.h"

namespace nerf {

// One light of a lights.json: what shines on some photographs, or is to shine on a surface. In the
// axes and units of the capture.
struct PlannedLight {
  std::string name;
  bool has_unknown_environment = false;       // it is to be found
  std::optional<EnvironmentMap> environment;  // absent, and not unknown: black
  double rotate = 0;                          // degrees, counter-clockwise from above
  double exposure = 0;                        // stops by which photographs show all of it brighter
  std::vector<DirectionalLight> suns;
  std::vector<PointLight> points;
};

// Lights, and which photographs they shine on.
struct LightPlan {
  std::vector<PlannedLight> lights;  // at least one
  // A pattern of names of photographs with * and ?, and the index of their light.
  std::vector<std::pair<std::string, int>> photographs;

  // The light of that name; nullopt: there is none.
  std::optional<int> Find(const std::string& name) const;
};

// Reads
//   {"lights": {"day": {"environment": "sky.hdr", "rotate": 90, "exposure": -1,
//                       "suns": [{"direction": [1, 0, 1], "irradiance": [3, 3, 2.5]}],
//                       "points": [{"position": [0, 1, 2], "watts": 40, "color": "D65"}]}},
//    "photographs": {"evening/*": "day"}}
// An environment is a file, relative to the JSON file, a named light (ColorOfLight), "unknown", or
// absent: black. A sun's direction points to it; its irradiance, on a surface that faces it, is a
// number or one a channel, by default pi: a white surface that faces it then has the value 1. A
// point has "watts" between 380 and 780 nm, "candela" or "lumens", and is isotropic. Both may have
// a "color", the name of a light. "photographs" may be absent where there is one light, or where
// the capture itself names the light of each photograph.
// Throws InputError naming the file and the key.
LightPlan ReadLightPlan(const std::filesystem::path& file);

// Copies a valid plan into another folder; the paths of its environments are made absolute.
void CopyLightPlan(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace nerf
