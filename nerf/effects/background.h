#pragma once

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"

namespace nerf {

struct PointShares;

// Surroundings at infinity, such as a sky: a learned colour per direction behind everything else
// (nerf/field/background.h).
struct BackgroundOptions {
  // In a finer map, texels that few photographs cover overfit: 64 was best of 16, 32, 64 and 128 on
  // validation photographs of generated captures.
  int resolution = 64;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("resolution", o.resolution, "rows", Between(2, 1024),
           "size of the map of directions, which has twice as many columns");
  }
};

// On where there are distant points and hardly any between them and the near ones.
Verdict JudgeBackground(const PointShares& shares);

extern const EffectDescriptor kBackgroundEffect;

}  // namespace nerf
