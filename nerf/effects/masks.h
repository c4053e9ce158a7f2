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

// Black pixels of the photographs' masks: "ignore", what stands there is not of the scene (a
// passer-by, the photographer's finger) and is never drawn; or "empty", nothing stands there (a
// subject that was cut out), as where alpha is 0. Photographs are read so (LoadPhotograph in
// nerf/scene/photograph.h).
struct MaskOptions {
  MaskMeaning meaning = MaskMeaning::kIgnore;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("meaning", o.meaning, "black pixels of a mask: ignore them, or nothing stands there");
  }
};

// What masks mean to those who read photographs; none where the effect is not simulated.
inline std::optional<MaskMeaning> MeaningOf(const std::optional<MaskOptions>& masks) {
  return masks ? std::optional(masks->meaning) : std::nullopt;
}

extern const EffectDescriptor kMasks;

}  // namespace nerf
