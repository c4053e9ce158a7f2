#include "nerf/effects/masks.h"

#include <spdlog/fmt/fmt.h>

namespace nerf {
namespace {

constexpr double kOneColor = 2.0 / 255;  // largest spread of a single colour, rounded to 8 bits

Verdict JudgeMasks(const PhotographFacts& facts) {
  if (facts.masks == 0) return Fact(kMasksEffect.name, false, 0, "no masks");
  // The surroundings of a subject that was cut out have one colour; content to ignore has many.
  const bool cut_out = facts.masked_spread < kOneColor;
  return Fact(kMasksEffect.name, true, facts.masks,
              fmt::format("{} of {} photographs have a mask; the masked {:.1f} % of the pixels {}",
                          facts.masks, facts.photographs, 100 * facts.masked_out,
                          cut_out ? "have one colour: empty" : "have content: ignore"),
              cut_out ? R"({"meaning": "empty"})" : R"({"meaning": "ignore"})");
}

}  // namespace

const EffectDescriptor kMasksEffect = {
    .name = "masks",
    .old_name = nullptr,
    .help = "pixels that are black in a mask are ignored, or empty",
    .stage = "pixel",
    .judge = [](const CaptureEvidence& e) { return JudgeMasks(e.facts); },
};

}  // namespace nerf
