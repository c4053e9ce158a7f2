#include "nerf/effects/masks.h"

#include <spdlog/fmt/fmt.h>

#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"

namespace nerf {
namespace {

constexpr double kOneColor = 2.0 / 255;  // largest spread of a single colour, rounded to 8 bits

Verdict JudgeMasks(const PhotographFacts& facts) {
  if (facts.masks == 0) return Fact(kMasksEffect.name, false, 0, "no masks");
  // The surroundings of a subject that was cut out have one colour; content to ignore has many.
  const bool cut_out = facts.masked_spread < kOneColor;
  const std::string found = fmt::format("{} of {} photographs have a mask, {:.1f} % masked out",
                                        facts.masks, facts.photographs, 100 * facts.masked_out);
  if (facts.masked_out == 0) {
    return Fact(kMasksEffect.name, false, 0, found + ": nothing is black, or has alpha 0");
  }
  return Fact(kMasksEffect.name, true, facts.masks,
              found + (cut_out ? ", of one colour: empty" : ", with content: ignore"),
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
