#pragma once

#include <string>
#include <vector>

#include "nerf/relight/lamps.h"

namespace nerf {

// The light on a group of photographs, in the frame of the surface and in the units of the
// photographs.
struct LightGroup {
  std::string name;           // empty: the only one
  torch::Tensor environment;  // [D,3] radiance from LightDirections(D); undefined: not known
  std::vector<Lamp> lamps;

  bool IsKnown() const { return environment.defined(); }
};

}  // namespace nerf
