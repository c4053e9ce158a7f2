#include "nerf/study/crop.h"

#include <gtest/gtest.h>

namespace nerf {
namespace {

TEST(Crop, FindsThePatchWithTheMostDetail) {
  Image image(80, 60, 3);
  for (int y = 30; y < 40; ++y) {
    for (int x = 50; x < 60; ++x) image.At(x, y)[1] = (x + y) % 2 == 0 ? 1.0f : 0.0f;
  }
  const Patch patch = MostDetailedPatch(image);
  EXPECT_EQ(patch.side, 15);
  EXPECT_LE(patch.left, 50);
  EXPECT_GE(patch.left + patch.side, 60);
  EXPECT_LE(patch.top, 30);
  EXPECT_GE(patch.top + patch.side, 40);
  const Image crop = Crop(image, patch);
  EXPECT_EQ(crop.width, 15);
  EXPECT_EQ(crop.At(50 - patch.left, 30 - patch.top)[1], 1.0f);
}

TEST(Crop, WorksForOnePixelAndForOneColour) {
  const Image pixel(1, 1, 3);
  EXPECT_EQ(Crop(pixel, MostDetailedPatch(pixel)).pixels.size(), 3u);
  const Patch patch = MostDetailedPatch(Image(16, 9, 4));
  EXPECT_EQ(patch.side, 2);
}

}  // namespace
}  // namespace nerf
