#include "nerf/image/image_files.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace nerf
