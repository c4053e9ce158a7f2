#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/image/mask.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// How photographs are read: how small, and what their masks mean where they count.
struct PhotographOptions {
  int downscale = 1;
  std::optional<MaskMeaning> masks;
  bool linear = false;  // display-referred ones too, as far as they are not white to the end of
                        // their scale: how bright it is there they do not say
};

// One photograph as evaluation and training see it: upright, downscaled, 3 or 4 channels.
struct Photograph {
  Image pixels;
  std::vector<std::uint32_t> whole;  // pixels that count, rising; empty: all
};
// Throws InputError naming what cannot be read, is not of its camera's size, or shows nothing
// that counts.
Photograph LoadPhotograph(const PosedImages& posed, const PosedImage& image,
                          const PhotographOptions& options);

// Whether all masks have the size of their photographs: one that has not is a mistake of all, and
// better told before an hour of training. Reads headers alone. Throws InputError.
void CheckMasks(const PosedImages& posed);

// The photographs to be read (not those held out) that are display-referred where others are
// linear, by their headers.
int DisplayReferredAmongLinear(const PosedImages& posed);

}  // namespace nerf
