#include "nerf/image/image_files.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/image/image_io.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using nerf::test::ScratchFolder;

TEST(ImageFiles, ExtensionsAreKnownInUpperAndLowerCase) {
  for (const char* name : {"a.jpg", "a.JPEG", "a.Png", "b/c.TIFF", "x.exr", "x.y.webp"}) {
    EXPECT_TRUE(HasImageExtension(name)) << name;
  }
  for (const char* name : {"jpg", "a.json", "a.mp4", "png.txt", ""}) {
    EXPECT_FALSE(HasImageExtension(name)) << name;
  }
}

TEST(ImageFiles, AreListedByNameWithoutFoldersAndHiddenFiles) {
  const ScratchFolder scratch;
  for (const char* name : {"b.png", "a.JPG", ".c.jpg", "notes.txt"}) scratch.Write(name, "x");
  std::filesystem::create_directory(scratch.path() / "d.png");
  EXPECT_THAT(ImageFilesIn(scratch.path()),
              testing::ElementsAre(scratch.path() / "a.JPG", scratch.path() / "b.png"));
  EXPECT_TRUE(ImageFilesIn(scratch.path() / "absent").empty());
}

TEST(ImageFiles, SizeIsAsStoredWithTheOrientation) {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "turned.tif";
  OIIO::ImageSpec spec(7, 5, 1, OIIO::TypeUInt8);
  spec.attribute("Orientation", 6);
  const auto output = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(output && output->open(file.string(), spec));
  const std::vector<unsigned char> pixels(35);
  output->write_image(OIIO::TypeUInt8, pixels.data());
  output->close();
  const auto size = ReadImageSize(file);
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, 7);
  EXPECT_EQ(size->height, 5);
  EXPECT_EQ(size->orientation, 6);
}

TEST(ImageFiles, OtherFilesHaveNoSize) {
  const ScratchFolder scratch;
  EXPECT_FALSE(ReadImageSize(scratch.Write("empty.jpg", "")));
  EXPECT_FALSE(ReadImageSize(scratch.Write("text.png", "hello")));
  EXPECT_FALSE(ReadImageSize(scratch.path() / "absent.png"));
}

TEST(FindImageFile, FindsOtherExtensionsAndOtherCase) {
  const test::ScratchFolder folder;
  for (const char* name :
       {"a.webp", "IMG_1.JPG", "b.png", "b.exr", "c.TIFF", "d.txt", "Twice.jpg", "twice.JPG"}) {
    folder.Write(name, "x");
  }
  const auto found = [&](const char* name) {
    const auto file = FindImageFile(folder.path() / name);
    return file ? file->filename().string() : "";
  };
  EXPECT_EQ(found("a"), "a.webp");
  EXPECT_EQ(found("b"), "b.png");
  EXPECT_EQ(found("b.exr"), "b.exr");
  EXPECT_EQ(found("img_1.jpg"), "IMG_1.JPG");
  EXPECT_EQ(found("img_1"), "IMG_1.JPG");
  EXPECT_EQ(found("c"), "c.TIFF");
  EXPECT_EQ(found("d"), "");
  EXPECT_EQ(found("TWICE.jpg"), "");  // which of the two?
}

TEST(FindImageFile, ReadsThePathsOfWindows) {
  const test::ScratchFolder folder;
  folder.Write("images/left/a.jpg", "x");
  const auto file = FindImageFile(folder.path() / "images\\left\\A.JPG");
  ASSERT_TRUE(file);
  EXPECT_TRUE(std::filesystem::equivalent(*file, folder.path() / "images/left/a.jpg"));
  folder.Write("odd\\name.png", "x");
  EXPECT_EQ(FindImageFile(folder.path() / "odd\\name.png"), folder.path() / "odd\\name.png");
}

TEST(ImageFile, MayHaveAQuestionMarkInItsName) {
  const test::ScratchFolder folder;
  for (const char* name : {"why?.png", "a?b=c.jpg", "what?.exr"}) {
    const std::filesystem::path file = folder.path() / name;
    WriteImage(file, Image(5, 3, 3));
    const auto size = ReadImageSize(file);
    ASSERT_TRUE(size) << name;
    EXPECT_EQ(size->width, 5);
    EXPECT_EQ(ReadImage(file, true).height, 3);
  }
}

TEST(IsScaledCopy, AllowsForTheRoundingOfBothSides) {
  EXPECT_TRUE(IsScaledCopy({1080, 1920}, {200, 356}));
  EXPECT_TRUE(IsScaledCopy({200, 356}, {1080, 1920}));
  EXPECT_TRUE(IsScaledCopy({5472, 3648}, {1600, 1067}));
  EXPECT_TRUE(IsScaledCopy({543, 961}, {136, 240}));
  EXPECT_FALSE(IsScaledCopy({1080, 1920}, {200, 360}));
  EXPECT_FALSE(IsScaledCopy({1080, 1920}, {1079, 1919}));  // cropped
  EXPECT_FALSE(IsScaledCopy({1080, 1920}, {356, 200}));
}

}  // namespace
}  // namespace nerf
