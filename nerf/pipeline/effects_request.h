#pragma once

#include <set>
#include <string>
#include <vector>

#include "nerf/effects/effects.h"

namespace nerf {

// What the user decides about the effects of a run.
struct EffectsRequest {
  // Whether the capture is inspected, for all effects that the user does not name. Otherwise they
  // are as configured.
  bool inspect = true;
  struct Choice {
    const EffectDescriptor* effect = nullptr;
    bool on = false;
  };
  std::vector<Choice> choices;

  // The choices as --set takes them.
  std::vector<std::string> Assignments() const;
};

// "auto", "config" (as configured, without an inspection), or a list such as
// "+exposure,-view_dependence", whose other effects stay automatic.
// Throws InputError naming an effect that does not exist.
EffectsRequest ParseEffects(const std::string& text);

}  // namespace nerf
