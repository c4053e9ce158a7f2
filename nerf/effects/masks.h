#pragma once

#include <optional>
#include <string>

#include "nerf/image/mask.h"

namespace nerf {

// Black pixels of the photographs' masks: "ignore", what stands there is not of the scene (a
// passer-by, the photographer's finger) and is never drawn; or "empty", nothing stands there (a
// subject that was cut out), as where alpha is 0. Photographs are read so (LoadPhotograph in
// nerf/data/photograph.h).
struct MaskOptions {
  std::string meaning = "ignore";

  void Check() const;
};

// What masks mean to those who read photographs; none where the effect is not simulated.
std::optional<MaskMeaning> MeaningOf(const std::optional<MaskOptions>& masks);

}  // namespace nerf
