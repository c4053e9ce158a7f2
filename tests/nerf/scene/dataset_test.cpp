#include "nerf/scene/dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "nerf/base/input_error.h"
#include "nerf/image/image_io.h"
#include "nerf/scene/camera.h"
#include "tests/support/input_error_of.h"
#include "tests/support/numbered_images.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using test::NumberedImages;

class LoadedDataset : public testing::Test {
 protected:
  LoadedDataset() : posed_(NumberedImages(3)) {
    for (int i = 0; i < 3; ++i) {
      Image image(4, 4, 3);
      std::ranges::fill(image.pixels, 0.25f * static_cast<float>(i + 1));
      posed_.images[i].path = folder_.path() / posed_.images[i].name;
      WriteImage(posed_.images[i].path, image);
    }
  }

  Dataset Load() { return LoadDataset(posed_, DataOptions(), masks_, {}); }

  // Masks out the lower half of the second photograph.
  void MaskTheSecond(int width = 4, int height = 4) {
    posed_.images[1].mask = folder_.path() / "mask.png";
    Image mask(width, height, 3);
    std::fill_n(mask.pixels.begin(), 3 * width * height / 2, 1.0f);
    WriteImage(posed_.images[1].mask, mask);
  }

  test::ScratchFolder folder_;
  PosedImages posed_;
  std::optional<MaskMeaning> masks_;
};

TEST_F(LoadedDataset, WhiteMasksChangeNothing) {
  const Dataset plain = Load();
  posed_.images[1].mask = folder_.path() / "mask.png";
  Image white(4, 4, 3);
  std::ranges::fill(white.pixels, 1.0f);
  WriteImage(posed_.images[1].mask, white);
  for (const MaskMeaning meaning : {MaskMeaning::kIgnore, MaskMeaning::kEmpty}) {
    masks_ = meaning;
    const Dataset masked = Load();
    EXPECT_EQ(masked.has_alpha, plain.has_alpha);
    for (std::size_t i = 0; i < plain.train.size(); ++i) {
      EXPECT_EQ(masked.train[i].rgba, plain.train[i].rgba);
      for (int k = 0; k < 16; ++k) EXPECT_EQ(masked.train[i].PixelIndex(k), k);
    }
  }
}

TEST_F(LoadedDataset, MaskedPixelsAreNotStored) {
  MaskTheSecond();
  EXPECT_EQ(Load().train[1].StoredCount(), 16);  // the effect is off
  masks_ = MaskMeaning::kIgnore;
  const Dataset data = Load();
  EXPECT_FALSE(data.has_alpha);
  EXPECT_EQ(data.train[0].StoredCount(), 16);
  ASSERT_EQ(data.train[1].StoredCount(), 8);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(data.train[1].PixelIndex(k), k);
  EXPECT_EQ(data.train[1].StoredNear(3), 3);
  EXPECT_EQ(data.train[1].StoredNear(15), 7);
}

TEST_F(LoadedDataset, PhotographsAmongLinearImagesAreLinearizedExceptClippedPixels) {
  Image radiance(4, 4, 3, ColorEncoding::kLinear);
  std::ranges::fill(radiance.pixels, 3.0f);
  posed_.images[0].path = folder_.path() / "0.exr";
  WriteImage(posed_.images[0].path, radiance);
  Image photograph(4, 4, 3);
  std::ranges::fill(photograph.pixels, 0.5f);
  std::fill_n(photograph.pixels.begin(), 3 * 4, 1.0f);  // the first row
  WriteImage(posed_.images[1].path, photograph);
  MaskTheSecond();  // two rows
  masks_ = MaskMeaning::kIgnore;
  const Dataset data = Load();
  EXPECT_EQ(data.encoding, ColorEncoding::kLinear);
  EXPECT_EQ(data.linearized_photographs, 2);
  EXPECT_EQ(data.train[0].StoredCount(), 16);
  EXPECT_EQ(static_cast<float>(data.train[0].rgba[0]), 3.0f);
  ASSERT_EQ(data.train[1].StoredCount(), 4);  // one row is white, two are masked out
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(data.train[1].PixelIndex(k), 4 + k);
    EXPECT_NEAR(static_cast<float>(data.train[1].rgba[4 * k]), 0.216f, 2e-3f);
  }
}

TEST_F(LoadedDataset, AClippedPhotographAmongLinearImagesIsSkipped) {
  Image radiance(4, 4, 3, ColorEncoding::kLinear);
  posed_.images[0].path = folder_.path() / "0.exr";
  WriteImage(posed_.images[0].path, radiance);
  Image white(4, 4, 3);
  std::ranges::fill(white.pixels, 1.0f);
  WriteImage(posed_.images[1].path, white);
  const Dataset data = Load();
  EXPECT_EQ(data.train.size(), 2u);
  ASSERT_EQ(data.skipped.size(), 1u);
  EXPECT_THAT(data.skipped[0], testing::HasSubstr("001.png"));
}

TEST_F(LoadedDataset, PixelsMaskedAsEmptyAreTransparent) {
  MaskTheSecond();
  masks_ = MaskMeaning::kEmpty;
  const Dataset data = Load();
  EXPECT_TRUE(data.has_alpha);
  ASSERT_EQ(data.train[1].StoredCount(), 16);
  for (int k = 0; k < 16; ++k) {
    EXPECT_EQ(static_cast<float>(data.train[1].rgba[4 * k + 3]), k < 8 ? 1.0f : 0.0f);
  }
}

TEST_F(LoadedDataset, AMaskOfAnotherSizeIsRefusedWithBothSizes) {
  MaskTheSecond(4, 2);
  masks_ = MaskMeaning::kIgnore;
  EXPECT_THAT(test::InputErrorOf([&] { Load(); }),
              testing::AllOf(testing::HasSubstr("mask.png"), testing::HasSubstr("4x2"),
                             testing::HasSubstr("4x4")));
}

TEST_F(LoadedDataset, AMaskThatIsNoImageIsRefused) {
  MaskTheSecond();
  std::ofstream(posed_.images[1].mask) << "none";
  masks_ = MaskMeaning::kIgnore;
  EXPECT_THAT(test::InputErrorOf([&] { Load(); }), testing::HasSubstr("mask.png"));
}

TEST_F(LoadedDataset, FullyTransparentPhotographsAreRefused) {
  for (const auto& image : posed_.images) WriteImage(image.path, Image(4, 4, 4));
  EXPECT_THAT(test::InputErrorOf([&] { Load(); }), testing::HasSubstr("fully transparent"));
}

TEST_F(LoadedDataset, StoresThePixels) {
  const Dataset data = Load();
  ASSERT_EQ(data.train.size(), 3u);
  EXPECT_FALSE(data.has_alpha);
  EXPECT_EQ(data.train[1].rgba.size(), 64u);
  EXPECT_NEAR(static_cast<float>(data.train[1].rgba[0]), 128 / 255.0f, 1e-3f);
  EXPECT_EQ(static_cast<float>(data.train[1].rgba[3]), 1.0f);
}

TEST_F(LoadedDataset, ADamagedPhotographIsReportedAndSkipped) {
  std::filesystem::resize_file(posed_.images[1].path, 40);
  const Dataset data = Load();
  EXPECT_EQ(data.train.size(), 2u);
  ASSERT_EQ(data.skipped.size(), 1u);
  EXPECT_THAT(data.skipped[0], testing::HasSubstr("001.png"));
}

TEST_F(LoadedDataset, WithoutAReadablePhotographThrows) {
  for (const auto& image : posed_.images) std::filesystem::resize_file(image.path, 0);
  EXPECT_THROW(Load(), InputError);
}

TEST_F(LoadedDataset, APhotographOfAnotherSizeThanItsCameraIsSkipped) {
  WriteImage(posed_.images[2].path, Image(5, 4, 3));
  const Dataset data = Load();
  ASSERT_EQ(data.skipped.size(), 1u);
  EXPECT_THAT(data.skipped[0],
              testing::AllOf(testing::HasSubstr("5x4"), testing::HasSubstr("4x4")));
}

TEST_F(LoadedDataset, ADownscaleThatDoesNotDivideTheImageDropsTheRemainder) {
  DataOptions options;
  options.downscale = 3;  // of 4 x 4 pixels
  const Dataset data = LoadDataset(posed_, options, {}, {});
  ASSERT_EQ(data.train.size(), 3u);
  EXPECT_EQ(data.train[0].camera, Downscaled(posed_.cameras[0], 3));
  EXPECT_EQ(data.train[0].camera.width, 1);
  EXPECT_EQ(data.train[0].StoredCount(), 1);
}

TEST_F(LoadedDataset, HeldOutPhotographsAreNotRead) {
  posed_.images[0].split = Split::kTest;
  std::filesystem::remove(posed_.images[0].path);
  const Dataset data = Load();
  EXPECT_EQ(data.train.size(), 2u);
  EXPECT_TRUE(data.skipped.empty());
}

TEST(LoadDataset, ASubsetOfThePixelsIsThatOfThePhotograph) {
  const test::ScratchFolder folder;
  PosedImages posed = NumberedImages(2);
  posed.cameras[0] = PinholeFromFov(500, 400, 1.0);
  for (PosedImage& image : posed.images) {
    image.split = Split::kTrain;
    image.path = folder.path() / image.name;
    Image photo(500, 400, 3);
    for (int p = 0; p < 500 * 400; ++p) {
      photo.pixels[3 * p] = static_cast<float>(p % 500 % 256) / 255;
      photo.pixels[3 * p + 1] = static_cast<float>(p / 500 % 256) / 255;
    }
    WriteImage(image.path, photo);
  }
  DataOptions options;
  options.memory_mb = 1;  // of 3.05 MB
  const Dataset data = LoadDataset(posed, options, {}, {});
  std::int64_t stored = 0;
  for (const View& view : data.train) {
    stored += view.StoredCount();
    for (std::int64_t k = 0; k < view.StoredCount(); k += 97) {
      const std::int64_t pixel = view.PixelIndex(k);
      EXPECT_NEAR(static_cast<float>(view.rgba[4 * k]), pixel % 500 % 256 / 255.0, 1e-3);
      EXPECT_NEAR(static_cast<float>(view.rgba[4 * k + 1]), pixel / 500 % 256 / 255.0, 1e-3);
    }
  }
  EXPECT_LE(stored * 8, 1 << 20);
  EXPECT_GT(stored * 8, (1 << 20) - 32);
}

}  // namespace
}  // namespace nerf
