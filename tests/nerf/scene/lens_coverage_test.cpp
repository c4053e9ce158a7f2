#include "nerf/scene/lens_coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace nerf {
namespace {

TEST(LensCoverage, OfAPinholeIsAll) {
  EXPECT_FALSE(PixelsInLens({CameraModel::kPinhole, 30, 20, {25, 25, 15, 10}}).has_value());
}

// At a focal length of 20 pixels an angle of pi from the axis is 63 pixels from the centre.
TEST(LensCoverage, OfAFisheyeIsItsCircle) {
  const Camera camera = {CameraModel::kSimpleRadialFisheye, 100, 100, {20, 50, 50, 0}};
  const std::vector<std::uint32_t> covered = PixelsInLens(camera).value();
  std::vector<std::uint32_t> expected;
  for (std::uint32_t y = 0; y < 100; ++y) {
    for (std::uint32_t x = 0; x < 100; ++x) {
      if (std::hypot(x + 0.5 - 50, y + 0.5 - 50) < 20 * std::numbers::pi) {
        expected.push_back(100 * y + x);
      }
    }
  }
  EXPECT_LT(expected.size(), 10000u);
  EXPECT_EQ(covered, expected);
}

}  // namespace
}  // namespace nerf
