#pragma once

#include <set>
#include <string>
#include <vector>

#include "nerf/effects/effects.h"

namespace nerf {

// The user's decisions about the effects of a run.
struct EffectsRequest {
  // Whether inspection and trials decide the effects that the user does not name; otherwise they
  // are as configured.
  bool inspect = true;
  struct Choice {
    const EffectDescriptor* effect = nullptr;
    bool on = false;
  };
  std::vector<Choice> choices;

  // The choices in the form of --set.
  std::vector<std::string> Assignments() const;
};

// Parses the value of --effects: "auto", "config" (as configured, without inspection), or a list
// such as "+exposure,-view_dependence", with all other effects automatic.
// Throws InputError naming an unknown effect.
EffectsRequest ParseEffects(const std::string& text);

}  // namespace nerf
