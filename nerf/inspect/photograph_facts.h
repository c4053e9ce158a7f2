#pragma once

#include "nerf/scene/posed_images.h"

namespace nerf {

// What the photographs are, whatever they show; of a few of them, spread over the capture.
struct PhotographFacts {
  int looked_at = 0;
  int photographs = 0;
  int masks = 0;             // photographs that have one
  double transparent = 0;    // share of the pixels
  double masked_out = 0;     // share of the pixels of those with masks
  double masked_spread = 0;  // standard deviation of what is masked out, sRGB in [0,1]
  double beyond_white = 0;   // share of linear pixels brighter than 1
  bool linear = false;
};

// Throws InputError naming a mask that cannot be read or is of another size.
PhotographFacts LookAtPhotographs(const PosedImages& posed);

}  // namespace nerf
