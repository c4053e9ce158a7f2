#pragma once

#include "nerf/image/image.h"

namespace nerf {

// A square part of an image.
struct Patch {
  int left = 0, top = 0, side = 0;  // pixels
};

// The patch with the most detail, which a bad rendering blurs first. Its side is a quarter of the
// image's shorter side.
Patch MostDetailedPatch(const Image& image);

// The pixels of a patch, which must be inside the image.
Image Crop(const Image& image, const Patch& patch);

}  // namespace nerf
