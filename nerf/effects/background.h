#pragma once

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"

namespace nerf {

// Surroundings without end, such as a sky, that differ in each direction: a learned colour behind
// everything (nerf/field/background.h).
struct BackgroundOptions {
  // Few photographs look into one direction: of a finer map each paints its own part (64 was best
  // of 16, 32, 64 and 128 on validation photographs of generated captures).
  int resolution = 64;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("resolution", o.resolution, "rows", Between(2, 1024),
           "size of the map of directions, which has twice as many columns");
  }
};

// On where points are far away and nothing stands between them and what is near.
Verdict JudgeBackground(const PointShares& shares);

extern const EffectDescriptor kBackground;

}  // namespace nerf
