#include "nerf/image/image_io.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/image_files.h"

namespace nerf {
namespace {

using test::GradientImage;
using test::ImageIo;
using test::WriteRaw;

TEST_F(ImageIo, PngKeepsEightBitValuesExactly) {
  const Image image = GradientImage(13, 7, 3);
  WriteImage(File("a.png"), image);
  const Image back = ReadImage(File("a.png"), false);
  ASSERT_EQ(back.width, 13);
  ASSERT_EQ(back.height, 7);
  ASSERT_EQ(back.channels, 3);
  EXPECT_EQ(back.encoding, ColorEncoding::kSrgb);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    ASSERT_NEAR(back.pixels[i], image.pixels[i], 1e-6) << i;
  }
}

TEST_F(ImageIo, PngAlphaIsStraightBothWays) {
  Image image(2, 1, 4);
  image.pixels = {0.8f, 0.4f, 0.2f, 0.2f, 1.0f, 0.6f, 0.0f, 0.0f};
  WriteImage(File("a.png"), image);
  const Image back = ReadImage(File("a.png"), false);
  ASSERT_EQ(back.channels, 4);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(back.pixels[i], image.pixels[i], 1e-6) << i;
}

TEST_F(ImageIo, ExrStoresPremultipliedAlphaAndReadsItStraight) {
  Image image(2, 1, 4, ColorEncoding::kLinear);
  image.pixels = {8.0f, 0.5f, -0.25f, 0.25f, 3.0f, 2.0f, 1.0f, 1.0f};
  WriteImage(File("a.exr"), image);
  std::vector<float> stored(8);
  auto raw = OIIO::ImageInput::open(File("a.exr").string());
  ASSERT_TRUE(raw->read_image(0, 0, 0, 4, OIIO::TypeFloat, stored.data()));
  EXPECT_EQ(stored, (std::vector<float>{2.0f, 0.125f, -0.0625f, 0.25f, 3.0f, 2.0f, 1.0f, 1.0f}));
  const Image back = ReadImage(File("a.exr"), false);
  EXPECT_EQ(back.encoding, ColorEncoding::kLinear);
  EXPECT_EQ(back.pixels, image.pixels);
}

TEST_F(ImageIo, ExrOfAnSrgbImageIsLinear) {
  Image image(1, 1, 3);
  image.pixels = {0.5f, 0.0f, 1.0f};
  WriteImage(File("a.exr"), image);
  const Image back = ReadImage(File("a.exr"), false);
  EXPECT_NEAR(back.pixels[0], 0.21404114f, 1e-6);
  EXPECT_NEAR(back.pixels[2], 1.0f, 1e-6);
}

TEST_F(ImageIo, PngOfALinearImageIsConvertedToSrgbAndClamped) {
  Image image(1, 1, 3, ColorEncoding::kLinear);
  image.pixels = {0.21404114f, 7.0f, -1.0f};
  WriteImage(File("a.png"), image);
  const Image back = ReadImage(File("a.png"), false);
  EXPECT_NEAR(back.pixels[0], 128 / 255.0, 1e-6);  // 127.5 rounds up
  EXPECT_EQ(back.pixels[1], 1);
  EXPECT_EQ(back.pixels[2], 0);
}

TEST_F(ImageIo, JpegIsCloseAndAlphaIsCompositedOnWhite) {
  Image image(32, 32, 4);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      float* p = image.At(x, y);
      p[0] = x / 31.0f, p[1] = y / 31.0f, p[2] = 0.5f, p[3] = x < 16 ? 0.0f : 1.0f;
    }
  }
  WriteImage(File("a.jpg"), image);
  const Image back = ReadImage(File("a.jpg"), false);
  ASSERT_EQ(back.channels, 3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.At(4, 20)[c], 1, 0.03);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.At(28, 20)[c], image.At(28, 20)[c], 0.03);
}

TEST_F(ImageIo, SixteenBitPngKeepsItsPrecision) {
  WriteRaw<std::uint16_t>(File("a.png"), OIIO::ImageSpec(2, 1, 3, OIIO::TypeUInt16),
                          {1, 2, 3, 32769, 65534, 65535});
  const Image image = ReadImage(File("a.png"), false);
  EXPECT_NEAR(image.pixels[0] * 65535, 1, 1e-3);
  EXPECT_NEAR(image.pixels[1] * 65535, 2, 1e-3);
  EXPECT_NEAR(image.pixels[3] * 65535, 32769, 0.01);
  EXPECT_EQ(image.encoding, ColorEncoding::kSrgb);
}

TEST_F(ImageIo, GreyBecomesRgb) {
  WriteRaw<std::uint8_t>(File("a.png"), OIIO::ImageSpec(2, 1, 1, OIIO::TypeUInt8), {51, 204});
  const Image image = ReadImage(File("a.png"), false);
  ASSERT_EQ(image.channels, 3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.At(0, 0)[c], 0.2, 1e-6);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.At(1, 0)[c], 0.8, 1e-6);
}

TEST_F(ImageIo, GreyWithAlphaBecomesRgba) {
  OIIO::ImageSpec spec(1, 1, 2, OIIO::TypeUInt8);
  spec.channelnames = {"Y", "A"};
  spec.alpha_channel = 1;
  spec.attribute("oiio:UnassociatedAlpha", 1);
  WriteRaw<std::uint8_t>(File("a.png"), spec, {204, 51});
  const Image image = ReadImage(File("a.png"), false);
  ASSERT_EQ(image.channels, 4);
  EXPECT_NEAR(image.pixels[0], 0.8, 1e-6);
  EXPECT_NEAR(image.pixels[2], 0.8, 1e-6);
  EXPECT_NEAR(image.pixels[3], 0.2, 1e-6);
}

TEST_F(ImageIo, ManyChannelsAreTakenByName) {
  OIIO::ImageSpec spec(1, 1, 6, OIIO::TypeFloat);
  spec.channelnames = {"Z", "B", "G", "R", "A", "id"};
  spec.alpha_channel = 4;
  WriteRaw<float>(File("a.exr"), spec, {9, 0.3f, 0.2f, 0.1f, 1, 8});
  const Image image = ReadImage(File("a.exr"), false);
  EXPECT_EQ(image.pixels, (std::vector<float>{0.1f, 0.2f, 0.3f, 1}));
}

TEST_F(ImageIo, ACroppedExrFillsItsDisplayWindow) {
  OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeFloat);
  spec.x = 2;
  spec.y = 1;
  spec.full_width = 4;
  spec.full_height = 3;
  WriteRaw<float>(File("a.exr"), spec, {1, 2, 3});
  const Image image = ReadImage(File("a.exr"), false);
  ASSERT_EQ(image.width, 4);
  ASSERT_EQ(image.height, 3);
  EXPECT_EQ(image.At(2, 1)[1], 2);
  EXPECT_EQ(image.At(1, 1)[1], 0);
  EXPECT_EQ(ReadImageHeader(File("a.exr")).width, 4);
}

// The picture "a b / c d / e f", stored so that the orientation shows it upright.
struct Turned {
  int width;
  std::string stored;
};

TEST_F(ImageIo, AllEightOrientationsAreRotatedUpright) {
  const std::vector<Turned> turned = {{2, "abcdef"}, {2, "badcfe"}, {2, "fedcba"}, {2, "efcdab"},
                                      {3, "acebdf"}, {3, "bdface"}, {3, "fdbeca"}, {3, "ecafdb"}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const auto& [width, stored] = turned[orientation - 1];
    OIIO::ImageSpec spec(width, 6 / width, 3, OIIO::TypeUInt8);
    spec.attribute("Orientation", orientation);
    std::vector<std::uint8_t> bytes;
    for (const char c : stored) bytes.insert(bytes.end(), 3, static_cast<std::uint8_t>(c));
    WriteRaw(File("a.tif"), spec, bytes);

    const ImageSize header = ReadImageHeader(File("a.tif"));
    EXPECT_EQ(header.orientation, orientation);
    EXPECT_EQ(header.width, width);
    const Image upright = ReadImage(File("a.tif"), true);
    ASSERT_EQ(upright.width, 2) << orientation;
    ASSERT_EQ(upright.height, 3) << orientation;
    std::string seen;
    for (int i = 0; i < 6; ++i) {
      seen += static_cast<char>(std::lround(upright.pixels[3 * i] * 255));
    }
    EXPECT_EQ(seen, "abcdef") << orientation;
    EXPECT_EQ(ReadImage(File("a.tif"), false).width, width) << orientation;
  }
}

TEST_F(ImageIo, JpegOrientationIsReadFromExif) {
  OIIO::ImageSpec spec(16, 8, 3, OIIO::TypeUInt8);
  spec.attribute("Orientation", 6);
  WriteRaw(File("a.jpg"), spec, std::vector<std::uint8_t>(16 * 8 * 3, 100));
  EXPECT_EQ(ReadImageHeader(File("a.jpg")).orientation, 6);
  EXPECT_EQ(ReadImage(File("a.jpg"), true).height, 16);
}

TEST_F(ImageIo, HdrIsLinear) {
  WriteRaw<float>(File("a.hdr"), OIIO::ImageSpec(1, 1, 3, OIIO::TypeFloat), {16, 4, 0.25f});
  const Image image = ReadImage(File("a.hdr"), false);
  EXPECT_EQ(image.encoding, ColorEncoding::kLinear);
  EXPECT_NEAR(image.pixels[0], 16, 0.2);
}

TEST_F(ImageIo, ExtensionsMayBeInCapitals) {
  WriteImage(File("a.PNG"), GradientImage(4, 4, 3));
  EXPECT_EQ(ReadImage(File("a.PNG"), false).width, 4);
}

}  // namespace
}  // namespace nerf
