#include "nerf/effects/masks.h"

#include <spdlog/fmt/fmt.h>

namespace nerf {
namespace {

constexpr double kOneColor = 2.0 / 255;  // spread of one colour, as files round it

Verdict JudgeMasks(const PhotographFacts& facts) {
  if (facts.masks == 0) return Fact(kMasks.name, false, 0, "no masks");
  // What was cut out is of one colour; what is to be ignored is a picture of something.
  const bool cut_out = facts.masked_spread < kOneColor;
  return Fact(kMasks.name, true, facts.masks,
              fmt::format("{} of {} photographs have one, {:.1f} % masked out, which {}",
                          facts.masks, facts.photographs, 100 * facts.masked_out,
                          cut_out ? "has one colour: empty" : "shows things: ignore"),
              cut_out ? R"({"meaning": "empty"})" : R"({"meaning": "ignore"})");
}

}  // namespace

const EffectDescriptor kMasks = {
    .name = "masks",
    .old_name = nullptr,
    .help = "black pixels of masks are ignored, or empty",
    .hook = "pixel",
    .judge = [](const CaptureEvidence& e) { return JudgeMasks(e.facts); },
};

}  // namespace nerf
