#include "nerf/image/silhouette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nerf {
namespace {

TEST(SilhouetteDistance, IsThatToTheNearestPixelOfTheOtherKind) {
  Image opacity(23, 17, 1);
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < 23; ++x) {
      *opacity.At(x, y) = std::hypot(x - 9, y - 8) < 5 || (x > 18 && y < 3) ? 0.9f : 0.1f;
    }
  }
  const Image distance = SilhouetteDistance(opacity);
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < 23; ++x) {
      const bool is_opaque = *opacity.At(x, y) > 0.5f;
      double nearest = 1e9;
      for (int v = 0; v < 17; ++v) {
        for (int u = 0; u < 23; ++u) {
          if ((*opacity.At(u, v) > 0.5f) == is_opaque) continue;
          nearest = std::min(nearest, std::hypot(u - x, v - y));
        }
      }
      EXPECT_NEAR(*distance.At(x, y), is_opaque ? 0.5 - nearest : nearest - 0.5, 1e-5);
    }
  }
}

TEST(SilhouetteDistance, IsInfiniteWhereThereIsNoBorder) {
  Image opacity(4, 3, 1);
  const auto all = [](const Image& image, float value) {
    return std::ranges::all_of(image.pixels, [&](float v) { return v == value; });
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(all(SilhouetteDistance(opacity), kInfinity));
  std::ranges::fill(opacity.pixels, 1.0f);
  EXPECT_TRUE(all(SilhouetteDistance(opacity), -kInfinity));
}

}  // namespace
}  // namespace nerf
