#include "nerf/pipeline/effects_request.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "nerf/base/input_error.h"
#include "nerf/config/config.h"
#include "nerf/inspect/verdict.h"

namespace nerf {

EffectsRequest ParseEffects(const std::string& text) {
  if (text == "auto") return {};
  if (text == "config") return {false, {}};
  EffectsRequest request;
  const std::vector<std::string> known = EffectNames();
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, ',');) {
    const bool on = word.starts_with('+'), off = word.starts_with('-');
    const std::string name = word.substr(on || off ? 1 : 0);
    if ((!on && !off) || std::ranges::find(known, name) == known.end()) {
      throw InputError(
          "--effects {}: '{}' is none; use auto, config, or a list like +exposure,-view of {}",
          text, word, fmt::join(known, ", "));
    }
    request.assignments.push_back(EffectAssignment(name, on ? "{}" : "null"));
  }
  return request;
}

}  // namespace nerf
