#include "nerf/output/color_map.h"

#include <gtest/gtest.h>

#include <limits>

#include "nerf/base/input_error.h"
#include "tests/support/constant_image.h"

namespace nerf {
namespace {

using test::ConstantImage;

Eigen::Vector3f At(const Image& image, int x, int y) {
  return Eigen::Map<const Eigen::Vector3f>(image.At(x, y));
}

TEST(Turbo, MatchesItsTable) {
  // Entries 64, 128 and 192 of the table by Mikhailov; the polynomial is within a tenth.
  EXPECT_LT((Turbo(64 / 255.0f) - Eigen::Vector3f(0.15844f, 0.73551f, 0.92305f)).norm(), 0.1f);
  EXPECT_LT((Turbo(128 / 255.0f) - Eigen::Vector3f(0.64362f, 0.98999f, 0.23356f)).norm(), 0.1f);
  EXPECT_LT((Turbo(192 / 255.0f) - Eigen::Vector3f(0.99297f, 0.50160f, 0.13530f)).norm(), 0.1f);
}

TEST(Turbo, GoesFromBlueToRed) {
  for (int i = -10; i <= 110; ++i) {
    const Eigen::Vector3f color = Turbo(static_cast<float>(i) / 100);
    EXPECT_GE(color.minCoeff(), 0);
    EXPECT_LE(color.maxCoeff(), 1);
  }
  EXPECT_GT(Turbo(0.1f).z(), Turbo(0.1f).x());
  EXPECT_GT(Turbo(0.9f).x(), Turbo(0.9f).z());
  EXPECT_EQ(Turbo(-3), Turbo(0));
  EXPECT_EQ(Turbo(3), Turbo(1));
}

TEST(Heat, BrightensFromBlackToWhite) {
  EXPECT_EQ(Heat(0), Eigen::Vector3f::Zero());
  EXPECT_EQ(Heat(1), Eigen::Vector3f::Ones());
  EXPECT_EQ(Heat(9), Eigen::Vector3f::Ones());
  for (int i = 0; i < 100; ++i) {
    EXPECT_GT(Heat((i + 1) / 100.0f).sum(), Heat(i / 100.0f).sum());
  }
}

TEST(ColorizeDepth, NearIsRedAndFarIsBlue) {
  Image depth(100, 1, 1);
  for (int x = 0; x < 100; ++x) *depth.At(x, 0) = 5.0f + static_cast<float>(x);
  const Image colors = ColorizeDepth(depth, ConstantImage(100, 1, 1, 1));
  EXPECT_EQ(At(colors, 0, 0), Turbo(1));
  EXPECT_EQ(At(colors, 99, 0), Turbo(0));
  EXPECT_LT((At(colors, 50, 0) - Turbo(0.49f)).norm(), 0.05f);
}

TEST(ColorizeDepth, IgnoresOutliersAndTransparentPixelsInTheRange) {
  Image depth(200, 1, 1);
  Image opacity = ConstantImage(200, 1, 1, 1);
  for (int x = 0; x < 200; ++x) *depth.At(x, 0) = 1 + static_cast<float>(x) / 199;
  const Image plain = ColorizeDepth(depth, opacity);
  *depth.At(0, 0) = 1e6f;
  *depth.At(1, 0) = -1e6f;
  for (int x = 190; x < 195; ++x) *depth.At(x, 0) = 1e6f, *opacity.At(x, 0) = 0;
  const Image colors = ColorizeDepth(depth, opacity);
  EXPECT_LT((At(colors, 100, 0) - At(plain, 100, 0)).norm(), 0.1f);
  EXPECT_EQ(At(colors, 192, 0), Eigen::Vector3f::Constant(0.5f));
}

TEST(ColorizeDepth, TransparentPixelsAreGrey) {
  const Image grey = ColorizeDepth(ConstantImage(4, 3, 1, 0), ConstantImage(4, 3, 1, 0));
  EXPECT_EQ(At(grey, 2, 1), Eigen::Vector3f::Constant(0.5f));
  const Image undefined = ColorizeDepth(
      ConstantImage(4, 3, 1, std::numeric_limits<float>::quiet_NaN()), ConstantImage(4, 3, 1, 1));
  EXPECT_EQ(At(undefined, 2, 1), Eigen::Vector3f::Constant(0.5f));
}

TEST(ColorizeDepth, OfAWallHasOneColour) {
  const Image wall = ColorizeDepth(ConstantImage(4, 3, 1, 2.5f), ConstantImage(4, 3, 1, 1));
  EXPECT_EQ(At(wall, 0, 0), At(wall, 3, 2));
}

TEST(ColorizeError, GrowsWithTheDifference) {
  Image a = ConstantImage(3, 1, 3, 0.5f);
  Image b = a;
  b.At(1, 0)[0] += 0.3f;
  for (int c = 0; c < 3; ++c) b.At(2, 0)[c] -= kWhiteError;
  const Image colors = ColorizeError(a, b);
  EXPECT_EQ(At(colors, 0, 0), Eigen::Vector3f::Zero());
  EXPECT_LT((At(colors, 1, 0) - Heat(0.1f / kWhiteError)).norm(), 1e-5f);
  EXPECT_LT((At(colors, 2, 0) - Eigen::Vector3f::Ones()).norm(), 1e-5f);
}

TEST(ColorMaps, RejectImagesOfDifferentSizes) {
  EXPECT_THROW(ColorizeError(Image(3, 4, 3), Image(4, 3, 3)), InputError);
  EXPECT_THROW(ColorizeDepth(Image(3, 4, 1), Image(4, 3, 1)), InputError);
}

}  // namespace
}  // namespace nerf
