#include "nerf/effects/masks.h"

#include "nerf/base/input_error.h"

namespace nerf {

void MaskOptions::Check() const {
  if (meaning == "ignore" || meaning == "empty") return;
  throw InputError("config: effects.masks.meaning is {}; use ignore or empty", meaning);
}

std::optional<MaskMeaning> MeaningOf(const std::optional<MaskOptions>& masks) {
  if (!masks) return std::nullopt;
  return masks->meaning == "empty" ? MaskMeaning::kEmpty : MaskMeaning::kIgnore;
}

}  // namespace nerf
