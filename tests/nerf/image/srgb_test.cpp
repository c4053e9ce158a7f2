#include "nerf/image/srgb.h"

#include <gtest/gtest.h>

namespace nerf {
namespace {

TEST(Srgb, MatchesTheStandardAtKnownPoints) {
  EXPECT_EQ(SrgbFromLinear(0), 0);
  EXPECT_NEAR(SrgbFromLinear(1), 1, 1e-6);
  EXPECT_NEAR(SrgbFromLinear(0.001f), 0.01292, 1e-7);
  EXPECT_NEAR(SrgbFromLinear(0.18f), 0.4613561, 1e-6);
  EXPECT_NEAR(LinearFromSrgb(0.5f), 0.2140411, 1e-6);
}

TEST(Srgb, InverseRestoresEveryValue) {
  for (int i = -400; i <= 1000; ++i) {
    const float x = static_cast<float>(i) / 200.0f;
    EXPECT_NEAR(LinearFromSrgb(SrgbFromLinear(x)), x, 4e-6) << x;
  }
}

TEST(Srgb, IsOddBelowZeroAndContinuesAboveOne) {
  EXPECT_EQ(SrgbFromLinear(-0.18f), -SrgbFromLinear(0.18f));
  EXPECT_EQ(LinearFromSrgb(-0.5f), -LinearFromSrgb(0.5f));
  EXPECT_NEAR(SrgbFromLinear(4), 1.8246, 1e-3);
}

TEST(Srgb, IsContinuousBetweenItsLinearAndItsPowerPart) {
  EXPECT_NEAR(SrgbFromLinear(0.0031307f), SrgbFromLinear(0.0031309f), 5e-6);
  EXPECT_NEAR(LinearFromSrgb(0.040449f), LinearFromSrgb(0.040451f), 1e-6);
}

TEST(ByteFromSrgb, RoundsHalfUpAndClamps) {
  EXPECT_EQ(ByteFromSrgb(-3), 0);
  EXPECT_EQ(ByteFromSrgb(0.4f / 255), 0);
  EXPECT_EQ(ByteFromSrgb(0.5f), 128);
  EXPECT_EQ(ByteFromSrgb(254.4f / 255), 254);
  EXPECT_EQ(ByteFromSrgb(1e30f), 255);
}

TEST(ByteFromSrgb, RestoresEveryByteOfAFile) {
  for (int i = 0; i < 256; ++i) EXPECT_EQ(ByteFromSrgb(static_cast<float>(i) / 255.0f), i);
}

}  // namespace
}  // namespace nerf
