#pragma once

#include <optional>
#include <utility>

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"
#include "nerf/image/mask.h"

namespace nerf {

template <>
struct EnumNames<MaskMeaning> {
  static constexpr std::pair<MaskMeaning, std::string_view> kNames[] = {
      {MaskMeaning::kIgnore, "ignore"}, {MaskMeaning::kEmpty, "empty"}};
};

// The meaning of pixels that are black in a photograph's mask: "ignore", they do not show the scene
// (a passer-by, the photographer's finger) and are not trained on; or "empty", nothing is there (a
// subject that was cut out), as where alpha is 0. Applied by LoadPhotograph
// (nerf/scene/photograph.h).
struct MaskOptions {
  MaskMeaning meaning = MaskMeaning::kIgnore;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("meaning", o.meaning,
           "pixels that are black in a mask are ignored, or show empty space");
  }
};

// The meaning of masks for LoadPhotograph; nullopt where the effect is off.
inline std::optional<MaskMeaning> MeaningOf(const std::optional<MaskOptions>& masks) {
  return masks ? std::optional(masks->meaning) : std::nullopt;
}

extern const EffectDescriptor kMasksEffect;

}  // namespace nerf
