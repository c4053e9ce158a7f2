#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "nerf/data/image.h"
#include "nerf/data/mask.h"
#include "sfm/posed_images.h"

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
// Throws sfm::InputError naming what cannot be read, is not of its camera's size, or shows nothing
// that counts.
Photograph LoadPhotograph(const sfm::PosedImages& posed, const sfm::PosedImage& image,
                          const PhotographOptions& options);

// The photographs to be read (not those held out) that are display-referred where others are
// linear, by their headers.
int DisplayReferredAmongLinear(const sfm::PosedImages& posed);

}  // namespace nerf
