#pragma once

#include "nerf/scene/posed_images.h"

namespace nerf {

// Properties of the files of a capture, from at most 8 photographs spread over it.
struct PhotographFacts {
  int examined = 0;
  int photographs = 0;
  int masks = 0;             // photographs that have one
  double transparent = 0;    // share of the pixels
  double masked_out = 0;     // share of the pixels of those with masks
  double masked_spread = 0;  // standard deviation of the pixels that are masked out, sRGB in [0,1]
  double above_white = 0;    // share of pixels above 1, which only linear ones can be
  bool linear = false;
};

// Photographs that cannot be read are skipped. Throws InputError naming a mask that cannot be read
// or differs in size from its photograph.
PhotographFacts ExaminePhotographs(const PosedImages& posed);

}  // namespace nerf
