#include "nerf/effects/effects.h"

#include <algorithm>

namespace nerf {

const std::vector<const EffectDescriptor*>& AllEffects() {
  static const std::vector<const EffectDescriptor*> all = [] {
    std::vector<const EffectDescriptor*> list;
    EffectsOptions options;
    EffectsOptions::VisitEffects(
        options, [&](const EffectDescriptor& effect, auto&) { list.push_back(&effect); });
    return list;
  }();
  return all;
}

const EffectDescriptor* FindEffect(const std::string& name) {
  const auto& all = AllEffects();
  const auto found = std::ranges::find_if(all, [&](const EffectDescriptor* effect) {
    return name == effect->name || (effect->old_name != nullptr && name == effect->old_name);
  });
  return found == all.end() ? nullptr : *found;
}

std::vector<std::string> EffectNames() {
  std::vector<std::string> names;
  for (const EffectDescriptor* effect : AllEffects()) names.emplace_back(effect->name);
  return names;
}

bool Simulates(const EffectsOptions& effects, const EffectDescriptor& effect) {
  bool on = false;
  EffectsOptions::VisitEffects(effects, [&](const EffectDescriptor& other, const auto& block) {
    if (&other == &effect) on = block.has_value();
  });
  return on;
}

}  // namespace nerf
