#include "nerf/scene/photograph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "nerf/image/image_io.h"
#include "tests/support/input_error_of.h"
#include "tests/support/numbered_images.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using test::InputErrorOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// One photograph of 7 x 5 pixels: a camera whose size a downscale by 2 does not divide.
class LoadedPhotograph : public testing::Test {
 protected:
  LoadedPhotograph() : posed_(test::NumberedImages(1)) {
    posed_.cameras[0] = PinholeFromFov(7, 5, 1.0);
    posed_.images[0].path = folder_.path() / "000.png";
    Write(Grey(7, 5));
  }

  static Image Grey(int width, int height) {
    Image image(width, height, 3);
    std::ranges::fill(image.pixels, 0.5f);
    return image;
  }
  void Write(const Image& image) { WriteImage(posed_.images[0].path, image); }
  void WriteMask(const Image& mask) {
    posed_.images[0].mask = folder_.path() / "mask.png";
    WriteImage(posed_.images[0].mask, mask);
  }
  Photograph Load(const PhotographOptions& options) {
    return LoadPhotograph(posed_, posed_.images[0], options);
  }

  test::ScratchFolder folder_;
  PosedImages posed_;
};

TEST_F(LoadedPhotograph, HasTheSizeOfItsCameraDownscaled) {
  for (const int downscale : {1, 2, 3, 5}) {
    const Camera camera = Downscaled(posed_.cameras[0], downscale);
    const Image pixels = Load({.downscale = downscale}).pixels;
    EXPECT_EQ(pixels.width, camera.width) << downscale;
    EXPECT_EQ(pixels.height, camera.height) << downscale;
  }
}

TEST_F(LoadedPhotograph, IsRefusedWhereTheDownscaleExceedsItsSize) {
  EXPECT_THAT(InputErrorOf([&] { Load({.downscale = 6}); }), HasSubstr("downscale factor 6"));
}

TEST_F(LoadedPhotograph, OfAnotherSizeThanItsCameraIsRefusedWithBothSizes) {
  for (const auto& [width, height] : {std::pair(5, 7), std::pair(14, 10), std::pair(7, 4)}) {
    Write(Grey(width, height));
    EXPECT_THAT(InputErrorOf([&] { Load({}); }),
                AllOf(HasSubstr("000.png"), HasSubstr("7x5"),
                      HasSubstr(fmt::format("{}x{} pixels", width, height))));
  }
}

TEST_F(LoadedPhotograph, HasInvalidPixelsWhereAnyPartOfABlockIsMasked) {
  Image mask(7, 5, 3);
  std::ranges::fill(mask.pixels, 1.0f);
  for (int c = 0; c < 3; ++c) mask.At(3, 1)[c] = 0;  // in block (1, 0)
  for (int c = 0; c < 3; ++c) mask.At(6, 4)[c] = 0;  // in no block
  WriteMask(mask);
  const PhotographOptions options = {.downscale = 2, .masks = MaskMeaning::kIgnore};
  EXPECT_THAT(Load(options).valid_pixels, ElementsAre(0, 2, 3, 4, 5));
  EXPECT_TRUE(Load({.downscale = 2}).valid_pixels.empty());  // masks are ignored
}

TEST_F(LoadedPhotograph, IsRefusedWhereTheWholeOfItIsMasked) {
  WriteMask(Image(7, 5, 3));
  EXPECT_THAT(InputErrorOf([&] { Load({.masks = MaskMeaning::kIgnore}); }), HasSubstr("mask.png"));
}

TEST_F(LoadedPhotograph, HasInvalidPixelsWhereItIsClippedAndConvertedToLinear) {
  Image image = Grey(7, 5);
  image.At(0, 0)[1] = 1.0f;
  Write(image);
  const Photograph linear = Load({.downscale = 2, .linear = true});
  EXPECT_EQ(linear.pixels.encoding, ColorEncoding::kLinear);
  EXPECT_THAT(linear.valid_pixels, ElementsAre(1, 2, 3, 4, 5));
  EXPECT_TRUE(Load({.downscale = 2}).valid_pixels.empty());  // not converted
  Write(Grey(7, 5));
  EXPECT_TRUE(Load({.downscale = 2, .linear = true}).valid_pixels.empty());  // all are valid
}

TEST_F(LoadedPhotograph, IsLinearizedOnlyAmongLinearOnes) {
  EXPECT_EQ(CountPhotographsToLinearize(posed_), 0);
  PosedImage radiance = posed_.images[0];
  radiance.path = folder_.path() / "001.exr";
  WriteImage(radiance.path, Grey(7, 5));
  posed_.images.push_back(radiance);
  EXPECT_EQ(CountPhotographsToLinearize(posed_), 1);
  posed_.images[1].split = Split::kTest;
  EXPECT_EQ(CountPhotographsToLinearize(posed_), 0);
}

}  // namespace
}  // namespace nerf
