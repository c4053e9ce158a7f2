#pragma once

#include <string>
#include <vector>

namespace nerf {

// What a person says of the effects to be simulated, with --effects.
struct EffectsRequest {
  bool inspect = true;                   // the others as the capture calls for them
  std::vector<std::string> assignments;  // of those that are asked for, "effects.NAME=..."
};

// "auto", "config" (as configured, without a look at the capture), or a list such as
// "+exposure,-view", whose other effects stay automatic.
// Throws InputError naming an effect that does not exist.
EffectsRequest ParseEffects(const std::string& text);

}  // namespace nerf
