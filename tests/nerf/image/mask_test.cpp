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
  const Image mask = ReadMask(folder.path() / "mask.png", 6, 4, false);
  EXPECT_EQ(std::ranges::count(mask.pixels, 1.0f), 9);
  EXPECT_EQ(std::ranges::count(mask.pixels, 0.0f), 15);
}

TEST(Mask, ExcludesPartlyMaskedPixelsOfADownscaledPhotograph) {
  const test::ScratchFolder folder;
  WriteImage(folder.path() / "mask.png", Square(6, 4));
  const Image mask = ReadMask(folder.path() / "mask.png", 6, 4, false);
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
  EXPECT_THAT(test::InputErrorOf([&] { ReadMask(folder.path() / "mask.png", 4, 6, false); }),
              testing::AllOf(testing::HasSubstr("6x4"), testing::HasSubstr("4x6")));
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
