#include "nerf/study/crop.h"

#include <algorithm>
#include <cmath>

namespace nerf {
namespace {

// Sum of the absolute differences between neighbouring pixels, at every second pixel.
double DetailOf(const Image& image, const Patch& patch) {
  double sum = 0;
  for (int y = patch.top; y + 1 < patch.top + patch.side; y += 2) {
    for (int x = patch.left; x + 1 < patch.left + patch.side; x += 2) {
      for (int c = 0; c < std::min(3, image.channels); ++c) {
        sum += std::fabs(image.At(x, y)[c] - image.At(x + 1, y)[c]) +
               std::fabs(image.At(x, y)[c] - image.At(x, y + 1)[c]);
      }
    }
  }
  return sum;
}

}  // namespace

Patch MostDetailedPatch(const Image& image) {
  const int side = std::max(1, std::min(image.width, image.height) / 4);
  const int stride = std::max(1, side / 4);
  Patch best{0, 0, side};
  double most = -1;
  for (int top = 0; top + side <= image.height; top += stride) {
    for (int left = 0; left + side <= image.width; left += stride) {
      const double detail = DetailOf(image, {left, top, side});
      if (detail <= most) continue;
      most = detail;
      best = {left, top, side};
    }
  }
  return best;
}

Image Crop(const Image& image, const Patch& patch) {
  Image crop(patch.side, patch.side, image.channels, image.encoding);
  for (int y = 0; y < patch.side; ++y) {
    std::copy_n(image.At(patch.left, patch.top + y), patch.side * image.channels, crop.At(0, y));
  }
  return crop;
}

}  // namespace nerf
