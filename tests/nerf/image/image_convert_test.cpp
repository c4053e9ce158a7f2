#include "nerf/image/image_convert.h"

#include <gtest/gtest.h>

#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/image/srgb.h"

namespace nerf {
namespace {

Image Make(int width, int height, int channels, ColorEncoding encoding,
           const std::vector<float>& values) {
  Image image(width, height, channels, encoding);
  image.pixels = values;
  return image;
}

TEST(ImageConvert, ConvertsToLinearAndBackAndKeepsAlpha) {
  const Image srgb = Make(1, 1, 4, ColorEncoding::kSrgb, {0.5f, 0.02f, 1.0f, 0.5f});
  const Image linear = ToLinear(srgb);
  EXPECT_EQ(linear.encoding, ColorEncoding::kLinear);
  EXPECT_NEAR(linear.pixels[0], 0.2140411, 1e-6);
  EXPECT_EQ(linear.pixels[3], 0.5f);
  const Image back = ToSrgb(linear);
  EXPECT_EQ(back.encoding, ColorEncoding::kSrgb);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(back.pixels[i], srgb.pixels[i], 1e-6);
  EXPECT_EQ(ToSrgb(srgb).pixels, srgb.pixels);
}

TEST(OnWhite, CompositesInSrgb) {
  const Image image =
      OnWhite(Make(2, 1, 4, ColorEncoding::kSrgb, {0.2f, 0.4f, 0, 0.25f, 0.1f, 0.2f, 0.3f, 1}));
  ASSERT_EQ(image.channels, 3);
  const std::vector<float> expected = {0.8f, 0.85f, 0.75f, 0.1f, 0.2f, 0.3f};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(image.pixels[i], expected[i], 1e-6);
}

TEST(OnWhite, ConvertsLinearImagesBeforeCompositing) {
  const Image image = OnWhite(Make(1, 1, 4, ColorEncoding::kLinear, {0.2140411f, 0, 1, 0.5f}));
  EXPECT_EQ(image.encoding, ColorEncoding::kSrgb);
  EXPECT_NEAR(image.pixels[0], 0.75, 1e-5);
  EXPECT_NEAR(image.pixels[1], 0.5, 1e-6);
}

TEST(Quantized, RoundsAndClamps) {
  const Image image = Quantized(Make(1, 1, 3, ColorEncoding::kSrgb, {0.5f, -1, 9}));
  EXPECT_EQ(image.pixels, (std::vector<float>{128 / 255.0f, 0, 1}));
}

TEST(Downscale, AveragesLightAndNotSrgbValues) {
  // Half white, half black reflects half the light: 0.735 in sRGB, not 0.5.
  const Image small =
      Downscale(Make(2, 2, 3, ColorEncoding::kSrgb, {0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0}), 2);
  ASSERT_EQ(small.width, 1);
  ASSERT_EQ(small.height, 1);
  EXPECT_EQ(small.encoding, ColorEncoding::kSrgb);
  EXPECT_NEAR(small.pixels[0], 0.7353569, 1e-5);
}

TEST(Downscale, KeepsAConstantColour) {
  for (const ColorEncoding encoding : {ColorEncoding::kSrgb, ColorEncoding::kLinear}) {
    const Image small = Downscale(Make(2, 2, 3, encoding, std::vector<float>(12, 0.4f)), 2);
    EXPECT_EQ(small.encoding, encoding);
    for (const float value : small.pixels) EXPECT_NEAR(value, 0.4f, 1e-6);
  }
}

TEST(Downscale, ColoursAreWeightedByTheirAlpha) {
  const Image small = Downscale(
      Make(2, 2, 4, ColorEncoding::kLinear, {1, 0, 0, 1, 0, 1, 0, 0.5f, 0, 0, 9, 0, 0, 0, 9, 0}),
      2);
  EXPECT_NEAR(small.pixels[0], 2 / 3.0, 1e-6);
  EXPECT_NEAR(small.pixels[1], 1 / 3.0, 1e-6);
  EXPECT_EQ(small.pixels[2], 0);
  EXPECT_NEAR(small.pixels[3], 0.375, 1e-6);
}

TEST(Downscale, NothingOpaqueKeepsAFiniteColour) {
  const Image small = Downscale(
      Make(2, 2, 4, ColorEncoding::kLinear, {1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}), 2);
  EXPECT_EQ(small.pixels, (std::vector<float>{0.5f, 0.5f, 0, 0}));
}

TEST(Downscale, DropsEdgesThatDoNotFillABlock) {
  Image image(7, 5, 3, ColorEncoding::kLinear);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      const bool whole = x < 6 && y < 4;
      for (int c = 0; c < 3; ++c) image.At(x, y)[c] = whole ? static_cast<float>(x / 2) : 100.0f;
    }
  }
  const Image small = Downscale(image, 2);
  ASSERT_EQ(small.width, 3);
  ASSERT_EQ(small.height, 2);
  for (int x = 0; x < 3; ++x) EXPECT_EQ(small.At(x, 1)[2], x);
}

TEST(Downscale, RefusesBlocksLargerThanTheImage) {
  EXPECT_THROW(Downscale(Image(7, 3, 3), 4), InputError);
  EXPECT_THROW(Downscale(Image(7, 3, 3), 0), InputError);
  EXPECT_EQ(Downscale(Image(7, 3, 3), 1).width, 7);
}

}  // namespace
}  // namespace nerf
