#pragma once

#include "nerf/image/image.h"

namespace nerf {

// A square part of an image.
struct Patch {
  int left = 0, top = 0, side = 0;  // pixels
};

// Where the picture changes most from pixel to pixel: what a bad rendering blurs first. A quarter
// of the shorter side across.
Patch BusiestPatch(const Image& image);

// The pixels of a patch, which must lie in the image.
Image Crop(const Image& image, const Patch& patch);

}  // namespace nerf
