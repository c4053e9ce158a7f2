#include "nerf/scene/view.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

TEST(View, StoredPixelsAreAStratifiedRandomSubset) {
  View view;
  view.camera = PinholeFromFov(100, 50, 1.0);
  view.rgba.resize(4 * 700);
  int repeated = 0;
  std::int64_t before = -1;
  for (std::int64_t k = 0; k < view.StoredCount(); ++k) {
    const std::int64_t pixel = view.PixelIndex(k);
    EXPECT_GE(pixel, 5000 * k / 700);
    EXPECT_LT(pixel, 5000 * (k + 1) / 700);
    repeated += pixel - before == 7;
    before = pixel;
  }
  EXPECT_LT(repeated, 200);  // not a regular grid
  View other = view;
  other.seed = 1;
  EXPECT_NE(other.PixelIndex(0) + other.PixelIndex(1) * 5000,
            view.PixelIndex(0) + view.PixelIndex(1) * 5000);
  view.rgba.resize(4 * 5000);
  EXPECT_EQ(view.PixelIndex(123), 123);
}

TEST(View, StoredNearIsAtThePixelOrNextToIt) {
  View view;
  view.camera = PinholeFromFov(100, 50, 1.0);
  view.rgba.resize(4 * 700);
  for (std::int64_t k = 0; k < view.StoredCount(); ++k) {
    EXPECT_LE(std::abs(view.StoredNear(view.PixelIndex(k)) - k), 1);
  }
  view.valid_pixels = {3, 10, 4999};
  view.rgba.resize(4 * 3);
  EXPECT_EQ(view.StoredNear(10), 1);
  EXPECT_EQ(view.StoredNear(0), 0);
  EXPECT_EQ(view.StoredNear(4999), 2);
}

}  // namespace
}  // namespace nerf
