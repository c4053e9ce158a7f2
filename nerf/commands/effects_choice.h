#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "nerf/config.h"
#include "nerf/data/dataset.h"
#include "nerf/inspect/inspect.h"
#include "nerf/train/model.h"
#include "sfm/posed_images.h"

namespace nerf {

// What a person says of the effects to be simulated, with --effects.
struct EffectsRequest {
  bool inspect = true;                   // the others as the capture calls for them
  std::vector<std::string> assignments;  // of those that are asked for, "effects.NAME=..."
};

// "auto", "config" (as configured, without a look at the capture), or a list such as
// "+exposure,-view", whose other effects stay automatic.
// Throws sfm::InputError naming an effect that does not exist.
EffectsRequest ParseEffects(const std::string& text);

// What was found and what was done about it.
struct EffectsChoice {
  Inspection inspection;
  std::vector<std::string> assignments;  // for what the capture calls for
  double seconds = 0;                    // of the look
  double trial_seconds = 0;              // of the trials
};

// Looks at the capture, and says which of the effects that nobody has named are to be simulated.
EffectsChoice ChooseEffects(const sfm::PosedImages& posed, const std::set<std::string>& named);

// The verdicts, as a table; a line where there was nothing to tell from.
void PrintEffects(const EffectsChoice& choice, const std::set<std::string>& named);

// Decides by paired trials, with the effect and without it, what the evidence left open: an effect
// is on that makes the validation photographs of a short training better. Prints what it found.
// Where there is no validation photograph, or the time budget is short, nothing is tried.
void TryWhatIsOpen(const Config& config, const SceneFacts& scene, const Dataset& data,
                   const std::set<std::string>& named, EffectsChoice& choice);

// RUN/effects.json: the verdicts with their evidence, who decided, and what is simulated.
void WriteEffects(const EffectsChoice& choice, const std::set<std::string>& named,
                  const std::filesystem::path& run);

}  // namespace nerf
