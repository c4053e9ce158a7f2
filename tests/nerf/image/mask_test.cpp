#include "nerf/image/mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "nerf/image/image_io.h"
#include "sfm/masks.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

// Black but for a square of 3 x 3 pixels in the corner.
Image Square(int width, int height) {
  Image mask(width, height, 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) std::fill_n(mask.At(x, y), 3, 0.5f);
  }
  return mask;
}

TEST(Mask, KeepsEveryPixelThatIsNotBlack) {
  const test::ScratchFolder folder;
  WriteImage(folder.path() / "mask.png", Square(6, 4));
  const Image mask = ReadMask(folder.path() / "mask.png", {6, 4});
  EXPECT_EQ(std::ranges::count(mask.pixels, 1.0f), 9);
  EXPECT_EQ(std::ranges::count(mask.pixels, 0.0f), 15);
}

TEST(Mask, ExcludesPartlyMaskedPixelsOfADownscaledPhotograph) {
  const test::ScratchFolder folder;
  WriteImage(folder.path() / "mask.png", Square(6, 4));
  const Image mask = ReadMask(folder.path() / "mask.png", {6, 4});
  EXPECT_EQ(UnmaskedPixels(mask, 1).size(), 9u);
  // The border of the mask crosses three of the four blocks of 2 x 2 pixels.
  EXPECT_EQ(UnmaskedPixels(mask, 2), std::vector<std::uint32_t>{0});
}

TEST(Mask, MultipliesAlpha) {
  Image photograph(2, 1, 4), mask(2, 1, 1, ColorEncoding::kLinear);
  photograph.pixels = {0.1f, 0.2f, 0.3f, 0.5f, 0.4f, 0.5f, 0.6f, 0.5f};
  mask.pixels = {1, 0};
  const Image out = WithMask(photograph, mask);
  EXPECT_EQ(out.pixels, (std::vector<float>{0.1f, 0.2f, 0.3f, 0.5f, 0.4f, 0.5f, 0.6f, 0.0f}));
}

TEST(Mask, OfAnotherSizeIsRefused) {
  const test::ScratchFolder folder;
  WriteImage(folder.path() / "mask.png", Square(6, 4));
  EXPECT_THAT(test::InputErrorOf([&] {
                ReadMask(folder.path() / "mask.png", {4, 6});
              }),
              testing::AllOf(testing::HasSubstr("6x4"), testing::HasSubstr("4x6")));
}

// What programs write as a mask: each keeps the left half.
TEST(Mask, OfEveryKindKeepsWhatItMarks) {
  const test::ScratchFolder folder;
  const int width = 16, height = 8;
  const auto write = [&](const std::string& name, int channels, const auto& pixel_at) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) pixel_at(x < width / 2, image.At(x, y));
    }
    WriteImage(folder.path() / name, image);
  };
  const auto fill = [](float* pixel, float color) { std::fill_n(pixel, 3, color); };
  write("black-white.png", 3, [&](bool keep, float* p) { fill(p, keep ? 1 : 0); });
  write("labels.png", 3, [&](bool keep, float* p) { fill(p, keep ? 1 / 255.0f : 0); });
  write("grey.png", 1, [&](bool keep, float* p) { *p = keep ? 0.5f : 0; });
  write("noisy.jpg", 3, [&](bool keep, float* p) { fill(p, keep ? 0.97f : 0.02f); });
  write("alpha-white.png", 4, [&](bool keep, float* p) { fill(p, 1), p[3] = keep ? 1 : 0; });
  write("alpha-black.png", 4, [&](bool keep, float* p) { fill(p, 0), p[3] = keep ? 0.7f : 0; });
  write("opaque.png", 4, [&](bool keep, float* p) { fill(p, keep ? 1 : 0), p[3] = 1; });
  for (const char* name : {"black-white.png", "labels.png", "grey.png", "noisy.jpg",
                           "alpha-white.png", "alpha-black.png", "opaque.png"}) {
    const Image mask = ReadMask(folder.path() / name, {width, height});
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        ASSERT_EQ(*mask.At(x, y), x < width / 2 ? 1 : 0) << name << " " << x << " " << y;
      }
    }
  }
}

// A photograph that EXIF turns, and masks painted on it upright or as it is stored.
TEST(Mask, OfATurnedPhotographMayBeUprightOrNot) {
  const test::ScratchFolder folder;
  for (int orientation = 5; orientation <= 8; ++orientation) {
    Image upright(4, 6, 3);
    std::fill_n(upright.At(3, 0), 3, 1.0f);  // one kept pixel
    // The photograph as stored: the inverse of turning it upright.
    const int inverse = orientation == 6 ? 8 : orientation == 8 ? 6 : orientation;
    const Image stored = TurnedUpright(upright, inverse);
    WriteImage(folder.path() / "upright.png", upright);
    WriteImage(folder.path() / "stored.png", stored);
    for (const char* name : {"upright.png", "stored.png"}) {
      const Image turned = ReadMask(folder.path() / name, {4, 6, orientation, true});
      EXPECT_EQ(std::ranges::count(turned.pixels, 1.0f), 1) << name << orientation;
      EXPECT_EQ(*turned.At(3, 0), 1) << name << orientation;
      const Image as_stored = ReadMask(folder.path() / name, {6, 4, orientation, false});
      for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 6; ++x) {
          EXPECT_EQ(*as_stored.At(x, y), stored.At(x, y)[0]) << name << orientation;
        }
      }
    }
  }
}

TEST(Mask, InAnotherSizeMasksOutWhateverItTouches) {
  const test::ScratchFolder folder;
  WriteImage(folder.path() / "mask.png", Square(8, 4));
  const Image half = ReadMask(folder.path() / "mask.png", {4, 2});
  EXPECT_EQ(half.pixels, (std::vector<float>{1, 0, 0, 0, 0, 0, 0, 0}));
  const Image twice = ReadMask(folder.path() / "mask.png", {16, 8});
  EXPECT_EQ(std::ranges::count(twice.pixels, 1.0f), 36);
}

TEST(FindMasks, LooksBesideThePhotographAndBesideItsFolder) {
  const test::ScratchFolder folder;
  const auto images = folder.path() / "images", masks = folder.path() / "masks";
  std::filesystem::create_directories(images / "masks");
  std::filesystem::create_directories(masks);
  PosedImages posed;
  for (const char* name : {"a.jpg", "b.jpg", "c.jpg", "d.jpg"}) {
    PosedImage image;
    image.path = images / name;
    posed.images.push_back(image);
  }
  for (const auto& file : {images / "masks" / "a.jpg.png", masks / "b.jpg.png", masks / "c.png"}) {
    WriteImage(file, Square(4, 4));
  }
  sfm::FindMasks(posed);
  EXPECT_EQ(posed.images[0].mask, images / "masks" / "a.jpg.png");
  EXPECT_EQ(posed.images[1].mask, masks / "b.jpg.png");
  EXPECT_EQ(posed.images[2].mask, masks / "c.png");
  EXPECT_TRUE(posed.images[3].mask.empty());
}

}  // namespace
}  // namespace nerf
