#include "sfm/colmap_images.h"

#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/image/image_files.h"
#include "tests/support/input_error_of.h"
#include "tests/support/photo_files.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nerf::test::WritePhoto;
using testing::ElementsAre;

std::vector<std::string> Names(const std::vector<ColmapImage>& plan) {
  std::vector<std::string> names;
  for (const ColmapImage& image : plan) names.push_back(image.name);
  return names;
}

class ColmapImages : public testing::Test {
 protected:
  std::vector<Photo> Photos() const { return CheckPhotos(ListPhotos(photos_.path())).photos; }
  fs::path Target() const { return target_.path() / "images"; }

  // Mean of the red channel over a part of an image, 0 to 255.
  static float MeanRed(const fs::path& file, int x0, int x1, int y0, int y1) {
    OIIO::ImageBuf image(file.string());
    EXPECT_TRUE(image.read(0, 0, true, OIIO::TypeFloat)) << file;
    float sum = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) sum += image.getchannel(x, y, 0, 0);
    }
    return 255 * sum / static_cast<float>((x1 - x0) * (y1 - y0));
  }

  ScratchFolder photos_;
  ScratchFolder target_;
};

TEST_F(ColmapImages, PhotosThatColmapCanUseAreLinked) {
  WritePhoto(photos_.path() / "a.jpg", 32, 16);
  WritePhoto(photos_.path() / "b.png", 32, 16, 1, OIIO::TypeUInt8, 4);
  const auto photos = Photos();
  const auto plan = PlanColmapImages(photos);
  EXPECT_THAT(Names(plan), ElementsAre("a.jpg", "b.png"));
  WriteColmapImages(photos, plan, Target());
  EXPECT_TRUE(fs::is_symlink(Target() / "a.jpg"));
  EXPECT_EQ(fs::read_symlink(Target() / "b.png"), photos[1].path);
}

TEST_F(ColmapImages, RotatedPhotosGetAnUprightCopyAndAreNotChanged) {
  // Stored with the bright half on the right; "turn by a quarter clockwise" brings it below.
  WritePhoto(photos_.path() / "a.jpg", 32, 16, 6);
  WritePhoto(photos_.path() / "b.jpg", 16, 32);
  const auto photos = Photos();
  const auto plan = PlanColmapImages(photos);
  EXPECT_THAT(Names(plan), ElementsAre("a.jpg", "b.jpg"));  // of one size once upright
  WriteColmapImages(photos, plan, Target());
  EXPECT_FALSE(fs::is_symlink(Target() / "a.jpg"));
  EXPECT_LT(MeanRed(Target() / "a.jpg", 0, 16, 0, 14), 60);
  EXPECT_GT(MeanRed(Target() / "a.jpg", 0, 16, 18, 32), 200);
  const auto written = CheckPhotos(ListPhotos(Target())).photos;
  EXPECT_EQ(written[0].orientation, 1);
  EXPECT_EQ(written[0].width, 16);
  EXPECT_EQ(Photos()[0].orientation, 6);
}

// EXIF 2.32, tag Orientation: which edges of the scene the first row and the first column show.
TEST_F(ColmapImages, EveryOrientationIsRotatedUpright) {
  constexpr int kWidth = 4, kHeight = 2;
  struct Case {
    int orientation;
    bool transposed, from_right, from_bottom;  // of the stored image, before it is transposed
  };
  for (const Case& c :
       {Case{2, false, true, false}, Case{3, false, true, true}, Case{4, false, false, true},
        Case{5, true, false, false}, Case{6, true, false, true}, Case{7, true, true, true},
        Case{8, true, true, false}}) {
    SCOPED_TRACE(c.orientation);
    const ScratchFolder folder, target;
    OIIO::ImageSpec spec(kWidth, kHeight, 3, OIIO::TypeUInt8);
    spec.attribute("Orientation", c.orientation);
    std::vector<unsigned char> stored(3 * kWidth * kHeight);
    for (int i = 0; i < kWidth * kHeight; ++i) stored[3 * i] = static_cast<unsigned char>(30 * i);
    for (const char* name : {"a.tif", "b.tif"}) {
      const auto output = OIIO::ImageOutput::create((folder.path() / name).string());
      ASSERT_TRUE(output && output->open((folder.path() / name).string(), spec));
      ASSERT_TRUE(output->write_image(OIIO::TypeUInt8, stored.data()));
      ASSERT_TRUE(output->close());
    }
    const auto photos = CheckPhotos(ListPhotos(folder.path())).photos;
    WriteColmapImages(photos, PlanColmapImages(photos), target.path() / "images");
    OIIO::ImageBuf image((target.path() / "images/a.tif.png").string());
    ASSERT_TRUE(image.read());
    ASSERT_EQ(image.spec().width, c.transposed ? kHeight : kWidth);
    for (int y = 0; y < image.spec().height; ++y) {
      for (int x = 0; x < image.spec().width; ++x) {
        const int column = c.transposed ? y : x, row = c.transposed ? x : y;
        const int from = (c.from_bottom ? kHeight - 1 - row : row) * kWidth +
                         (c.from_right ? kWidth - 1 - column : column);
        EXPECT_NEAR(255 * image.getchannel(x, y, 0, 0), 30 * from, 0.6) << x << ", " << y;
      }
    }
  }
}

TEST_F(ColmapImages, ACroppedExrHasTheSizeOfItsDisplayWindow) {
  OIIO::ImageSpec spec(10, 6, 3, OIIO::TypeHalf);
  spec.x = 4;
  spec.y = 2;
  spec.full_width = 32;
  spec.full_height = 16;
  const std::vector<float> pixels(3 * 60, 1.0f);
  for (const char* name : {"a.exr", "b.exr"}) {
    const std::string file = (photos_.path() / name).string();
    const auto output = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(output && output->open(file, spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, pixels.data()));
    ASSERT_TRUE(output->close());
  }
  const auto photos = Photos();
  EXPECT_EQ(photos[0].width, 32);
  EXPECT_EQ(ReadImageSize(photos[0].path)->height, 16);
  WriteColmapImages(photos, PlanColmapImages(photos), Target());
  EXPECT_NEAR(MeanRed(Target() / "a.exr.png", 4, 14, 2, 8), 255, 1);
  EXPECT_NEAR(MeanRed(Target() / "a.exr.png", 15, 32, 0, 16), 0, 1);
}

TEST_F(ColmapImages, SixteenBitAndFloatPhotosGetAnEightBitCopy) {
  WritePhoto(photos_.path() / "a.png", 32, 16, 1, OIIO::TypeUInt16);
  WritePhoto(photos_.path() / "b.exr", 32, 16, 1, OIIO::TypeHalf);
  const auto photos = Photos();
  const auto plan = PlanColmapImages(photos);
  EXPECT_THAT(Names(plan), ElementsAre("a.png.png", "b.exr.png"));
  WriteColmapImages(photos, plan, Target());
  for (const Photo& stand_in : CheckPhotos(ListPhotos(Target())).photos) {
    EXPECT_TRUE(stand_in.eight_bit) << stand_in.name;
    EXPECT_EQ(stand_in.width, 32);
  }
  EXPECT_NEAR(MeanRed(Target() / "a.png.png", 0, 16, 0, 16), 0.1 * 255, 1);
  // Linear 0.1 and 0.9, scaled so that the brightest is white: sRGB of 1/9 and 1.
  EXPECT_NEAR(MeanRed(Target() / "b.exr.png", 0, 16, 0, 16), 93.8, 1.5);
  EXPECT_NEAR(MeanRed(Target() / "b.exr.png", 16, 32, 0, 16), 255, 1);
}

TEST_F(ColmapImages, EachOfSeveralSizesGetsItsFolder) {
  WritePhoto(photos_.path() / "a.jpg", 32, 16);
  WritePhoto(photos_.path() / "b.jpg", 40, 16);
  const auto photos = Photos();
  const auto plan = PlanColmapImages(photos);
  EXPECT_THAT(Names(plan), ElementsAre("32x16/a.jpg", "40x16/b.jpg"));
  WriteColmapImages(photos, plan, Target());
  EXPECT_TRUE(fs::exists(Target() / "40x16/b.jpg"));
}

TEST_F(ColmapImages, CopiesDoNotTakeTheNameOfAnotherPhoto) {
  WritePhoto(photos_.path() / "a.exr", 32, 16);
  WritePhoto(photos_.path() / "a.exr.png", 32, 16);
  EXPECT_THAT(Names(PlanColmapImages(Photos())), ElementsAre("a.exr.png.png", "a.exr.png"));
}

TEST_F(ColmapImages, UnwritableTargetIsNamed) {
  WritePhoto(photos_.path() / "a.jpg", 32, 16);
  WritePhoto(photos_.path() / "b.jpg", 32, 16);
  const auto photos = Photos();
  const fs::path file = target_.Write("in_the_way", "");
  EXPECT_THAT(
      InputErrorOf([&] { WriteColmapImages(photos, PlanColmapImages(photos), file / "images"); }),
      testing::HasSubstr("in_the_way"));
}

}  // namespace
}  // namespace nerf::sfm
