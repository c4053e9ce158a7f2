#include "nerf/pipeline/inspection_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "nerf/output/draw_text.h"

namespace nerf {
namespace {

struct Extent {
  int count = 0, top = 1 << 20, bottom = -1;
};

// The blue pixels (bars) in a range of columns; text and lines are grey.
Extent Blue(const Image& image, int left, int right) {
  Extent extent;
  for (int y = 0; y < image.height; ++y) {
    for (int x = left; x < right; ++x) {
      const float* const at = image.At(x, y);
      if (at[2] < at[0] + 0.2f) continue;
      ++extent.count;
      extent.top = std::min(extent.top, y);
      extent.bottom = std::max(extent.bottom, y);
    }
  }
  return extent;
}

TEST(InspectionPicture, HasABarForEachPhotographUpOrDownFromTheMean) {
  Inspection inspection;
  inspection.stops = {1, -1};
  const Image image = PictureOf(inspection);
  // The left and the right half of the left plot.
  const Extent up = Blue(image, 0, 345), down = Blue(image, 345, 640);
  EXPECT_GT(up.count, 1000);
  EXPECT_LE(up.bottom, down.top);
  EXPECT_NEAR(up.count, down.count, 0.02 * up.count);
  inspection.stops = {1, -0.5};
  EXPECT_NEAR(Blue(PictureOf(inspection), 345, 640).count, down.count / 2, 0.02 * down.count);
}

TEST(InspectionPicture, DrawsLargerResidualsHigher) {
  Inspection inspection;
  inspection.residuals = {{2.5, 100, {0.1, 0.2, 0.3}}, {47.5, 100, {1, 2, 3}}};
  const Image image = PictureOf(inspection);
  const int middle = image.width * 3 / 4;
  const Extent low = Blue(image, image.width / 2, middle), high = Blue(image, middle, image.width);
  EXPECT_GT(low.count, 50);
  EXPECT_LT(high.bottom, low.top);
  EXPECT_GT(high.bottom - high.top, 5 * (low.bottom - low.top));
}

TEST(InspectionPicture, WithoutDataDrawsOnlyText) {
  const Image image = PictureOf({});
  EXPECT_EQ(Blue(image, 0, image.width).count, 0);
  const auto dark = std::ranges::count_if(image.pixels, [](float v) { return v < 0.5f; });
  EXPECT_EQ(dark > 0, HasFont());
}

}  // namespace
}  // namespace nerf
