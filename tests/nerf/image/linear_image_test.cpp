#include "nerf/image/linear_image.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "nerf/image/image_io.h"
#include "nerf/image/srgb.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_dng.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr InputEncoding kAll[] = {InputEncoding::kAuto, InputEncoding::kSrgb,
                                  InputEncoding::kLinear};

template <class T>
void WriteGrey(const fs::path& file, T value) {
  const OIIO::ImageSpec spec(4, 3, 3, OIIO::BaseTypeFromC<T>::value);
  const std::vector<T> values(4 * 3 * 3, value);
  auto output = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(output && output->open(file.string(), spec));
  ASSERT_TRUE(output->write_image(spec.format, values.data()));
}

TEST(LinearImage, OfSixteenBitsIsLinearUnlessSetToSrgb) {
  const test::ScratchFolder scratch;
  const fs::path file = scratch.path() / "deep.png";
  WriteGrey<std::uint16_t>(file, 16384);
  EXPECT_TRUE(StoresLinearLight(file));
  EXPECT_TRUE(StoresIntegers(file));
  EXPECT_NEAR(ReadLinearImage(file, InputEncoding::kAuto).pixels[0], 0.25, 1e-5);
  EXPECT_NEAR(ReadLinearImage(file, InputEncoding::kLinear).pixels[0], 0.25, 1e-5);
  EXPECT_NEAR(ReadLinearImage(file, InputEncoding::kSrgb).pixels[0], LinearFromSrgb(0.25f), 1e-4);
}

TEST(LinearImage, OfEightBitsIsSrgbUnlessSetToLinear) {
  const test::ScratchFolder scratch;
  const fs::path file = scratch.path() / "photo.png";
  WriteGrey<std::uint8_t>(file, 51);
  EXPECT_FALSE(StoresLinearLight(file));
  EXPECT_NEAR(ReadLinearImage(file, InputEncoding::kAuto).pixels[0], LinearFromSrgb(0.2f), 1e-6);
  EXPECT_NEAR(ReadLinearImage(file, InputEncoding::kLinear).pixels[0], 0.2, 1e-6);
}

TEST(LinearImage, OfFloatsIsLinearAndDoesNotClip) {
  const test::ScratchFolder scratch;
  const fs::path file = scratch.path() / "measured.exr";
  WriteGrey<float>(file, 7.5f);
  EXPECT_FALSE(StoresIntegers(file));
  for (const InputEncoding encoding : kAll) {
    EXPECT_EQ(ReadLinearImage(file, encoding).pixels[0], 7.5f);
  }
}

// The sensor signal is linear; the decoder applies the sRGB curve for display.
TEST(LinearImage, OfCameraRawIsTheLinearSensorSignal) {
  const test::ScratchFolder scratch;
  for (const int count : {1311, 16384, 32768}) {
    const fs::path file = scratch.Write("grey.dng", test::TinyDng(64, 64, [&](int, int) {
                                          return static_cast<std::uint16_t>(count);
                                        }));
    EXPECT_TRUE(StoresLinearLight(file));
    for (const InputEncoding encoding : kAll) {
      const Image image = ReadLinearImage(file, encoding);
      ASSERT_EQ(image.encoding, ColorEncoding::kLinear);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(image.At(32, 32)[c], count / 65535.0, 0.002 * count / 65535.0 + 2e-5) << c;
      }
    }
  }
}

// Renderers store colours that are multiplied by alpha: they are the light, also where alpha is 0.
TEST(LinearImage, OfAnExrWithAlphaIsWhatIsStored) {
  const test::ScratchFolder scratch;
  const fs::path file = scratch.path() / "rendered.exr";
  const OIIO::ImageSpec spec(3, 1, 4, OIIO::TypeFloat);
  const std::vector<float> values = {0.2f, 0.3f, 0.4f, 0.5f, 5, 6, 7, 0, 1, 2, 3, 1};
  auto output = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(output && output->open(file.string(), spec));
  ASSERT_TRUE(output->write_image(spec.format, values.data()));
  output->close();
  for (const InputEncoding encoding : kAll) {
    EXPECT_EQ(ReadLinearImage(file, encoding).pixels,
              (std::vector<float>{0.2f, 0.3f, 0.4f, 5, 6, 7, 1, 2, 3}));
  }
  // Photographs have straight colours, which are composited where they are used.
  EXPECT_EQ(ReadImage(file, false).pixels[0], 0.4f);
}

}  // namespace
}  // namespace nerf
