#include "nerf/pipeline/effects_request.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <sstream>

#include "nerf/base/input_error.h"
#include "nerf/inspect/verdict.h"

namespace nerf {

std::vector<std::string> EffectsRequest::Assignments() const {
  std::vector<std::string> assignments;
  for (const Choice& choice : choices) {
    assignments.push_back(EffectAssignment(choice.effect->name, choice.on ? "{}" : "null"));
  }
  return assignments;
}

EffectsRequest ParseEffects(const std::string& text) {
  if (text == "auto") return {};
  if (text == "config") return {false, {}};
  EffectsRequest request;
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, ',');) {
    const bool on = word.starts_with('+'), off = word.starts_with('-');
    const EffectDescriptor* const effect = FindEffect(word.substr(on || off ? 1 : 0));
    if ((!on && !off) || effect == nullptr) {
      throw InputError(
          "--effects {}: '{}' is not + or - and an effect; use auto, config, or a list like "
          "+exposure,-view_dependence of {}",
          text, word, fmt::join(EffectNames(), ", "));
    }
    request.choices.push_back({effect, on});
  }
  return request;
}

}  // namespace nerf
