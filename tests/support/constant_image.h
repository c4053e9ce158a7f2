#pragma once

#include "nerf/image/image.h"

namespace nerf::test {

inline Image ConstantImage(int width, int height, int channels, float value) {
  Image image(width, height, channels);
  for (float& v : image.pixels) v = value;
  return image;
}

}  // namespace nerf::test
