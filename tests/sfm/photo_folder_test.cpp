#include "sfm/photo_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/input_error_of.h"
#include "tests/support/photo_files.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::FileBytes;
using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nerf::test::WritePhoto;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string FoxBytes() { return FileBytes(fs::path(NERF_TEST_DATA) / "fox/images/0001.jpg"); }

std::vector<std::string> Names(const PhotoFolder& folder) {
  std::vector<std::string> names;
  for (const Photo& photo : folder.photos) names.push_back(photo.name);
  return names;
}

std::vector<std::string> SkippedNames(const PhotoFolder& folder) {
  std::vector<std::string> names;
  for (const SkippedPhoto& photo : folder.skipped) names.push_back(photo.name);
  return names;
}

TEST(PhotoFolder, PhotosAreSortedByNameAndOtherFilesIgnored) {
  const ScratchFolder scratch;
  WritePhoto(scratch.path() / "b.JPG", 20, 10);
  WritePhoto(scratch.path() / "a.png", 20, 10);
  WritePhoto(scratch.path() / ".hidden.png", 20, 10);
  scratch.Write("notes.txt", "no photo");
  scratch.Write("folder.png/x", "a folder with a photo's ending");
  const PhotoFolder folder = CheckPhotos(ListPhotos(scratch.path()));
  EXPECT_THAT(Names(folder), ElementsAre("a.png", "b.JPG"));
  EXPECT_TRUE(folder.skipped.empty());
  EXPECT_TRUE(folder.photos[0].path.is_absolute());
  EXPECT_EQ(folder.photos[0].format, "png");
  EXPECT_EQ(folder.photos[1].width, 20);
  EXPECT_EQ(folder.photos[1].height, 10);
}

TEST(PhotoFolder, JpegOfTheFoxTruncatedAnywhereIsSkipped) {
  const ScratchFolder scratch;
  const std::string whole = FoxBytes();
  ASSERT_GT(whole.size(), 100000u);
  scratch.Write("good1.jpg", whole);
  scratch.Write("good2.jpg", whole);
  std::vector<std::string> cut;
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{100}, std::size_t{5000}, whole.size() / 2, whole.size() - 1000,
        whole.size() - 100, whole.size() - 2}) {
    cut.push_back("cut_" + std::to_string(1000000 + length) + ".jpg");
    scratch.Write(cut.back(), whole.substr(0, length));
  }
  const PhotoFolder folder = CheckPhotos(ListPhotos(scratch.path()));
  EXPECT_THAT(Names(folder), ElementsAre("good1.jpg", "good2.jpg"));
  EXPECT_EQ(SkippedNames(folder), cut);
  EXPECT_EQ(folder.skipped[3].reason, "truncated");
}

TEST(PhotoFolder, DataThatAPhoneAppendsToTheFoxsJpegIsIgnored) {
  const ScratchFolder scratch;
  scratch.Write("motion.jpg", FoxBytes() + std::string(5000, 'v'));
  scratch.Write("plain.jpg", FoxBytes());
  EXPECT_TRUE(CheckPhotos(ListPhotos(scratch.path())).skipped.empty());
}

TEST(PhotoFolder, TruncatedAndForeignFilesOfOtherFormatsAreSkipped) {
  const ScratchFolder scratch;
  WritePhoto(scratch.path() / "good1.png", 64, 64);
  WritePhoto(scratch.path() / "good2.tif", 64, 64);
  for (const char* name : {"cut.png", "cut.bmp", "cut.tif", "cut.exr", "cut.ppm"}) {
    WritePhoto(scratch.path() / name, 64, 64);
    const std::string whole = FileBytes(scratch.path() / name);
    scratch.Write(name, whole.substr(0, whole.size() / 2));
  }
  scratch.Write("text.png", "this is no image at all");
  const PhotoFolder folder = CheckPhotos(ListPhotos(scratch.path()));
  EXPECT_THAT(Names(folder), ElementsAre("good1.png", "good2.tif"));
  EXPECT_THAT(SkippedNames(folder),
              ElementsAre("cut.bmp", "cut.exr", "cut.png", "cut.ppm", "cut.tif", "text.png"));
}

TEST(PhotoFolder, HeaderWithAnAbsurdSizeIsRefused) {
  const ScratchFolder scratch;
  scratch.WriteImage("a.ppm", 8, 8);
  scratch.WriteImage("b.ppm", 8, 8);
  scratch.Write("huge.ppm", "P6\n2000000000 2000000000\n255\nxx");
  EXPECT_THAT(SkippedNames(CheckPhotos(ListPhotos(scratch.path()))), ElementsAre("huge.ppm"));
}

TEST(PhotoFolder, OrientationAndDepthAreRead) {
  const ScratchFolder scratch;
  WritePhoto(scratch.path() / "1.jpg", 20, 10, 6);
  WritePhoto(scratch.path() / "2.png", 20, 10, 1, OIIO::TypeUInt16);
  WritePhoto(scratch.path() / "3.exr", 20, 10, 1, OIIO::TypeHalf);
  const auto photos = CheckPhotos(ListPhotos(scratch.path())).photos;
  ASSERT_EQ(photos.size(), 3u);
  EXPECT_EQ(photos[0].orientation, 6);
  EXPECT_EQ(photos[0].UprightWidth(), 10);
  EXPECT_EQ(photos[0].UprightHeight(), 20);
  EXPECT_TRUE(photos[0].eight_bit);
  EXPECT_EQ(photos[1].UprightWidth(), 20);
  EXPECT_FALSE(photos[1].eight_bit);
  EXPECT_FALSE(photos[2].eight_bit);
}

TEST(PhotoFolder, UnusableFoldersAreNamedWithTheFix) {
  const ScratchFolder scratch;
  const auto error = [](const fs::path& folder) {
    return InputErrorOf([&] { ListPhotos(folder); });
  };
  EXPECT_THAT(error(scratch.path() / "absent"), AllOf(HasSubstr("absent"), HasSubstr("no such")));
  EXPECT_THAT(error(scratch.Write("file.jpg", "x")), HasSubstr("is a file"));
  fs::create_directory(scratch.path() / "empty");
  EXPECT_THAT(error(scratch.path() / "empty"), HasSubstr("contains no photographs; give"));
  scratch.Write("phone/a.MOV", "x");
  EXPECT_THAT(error(scratch.path() / "phone"), HasSubstr("(but .MOV files)"));
  EXPECT_THAT(error(scratch.path()), HasSubstr("contains only one photograph, file.jpg"));
}

TEST(PhotoFolder, FewerThanTwoReadableIsAnErrorWithTheCount) {
  const ScratchFolder scratch;
  WritePhoto(scratch.path() / "a.png", 8, 8);
  scratch.Write("b.png", "broken");
  scratch.Write("c.png", "broken");
  EXPECT_THAT(InputErrorOf([&] { CheckPhotos(ListPhotos(scratch.path())); }),
              AllOf(HasSubstr("only 1 of 3"), HasSubstr("b.png")));
}

TEST(PhotoFolder, PhotosInSubFoldersHaveThemInTheirNames) {
  const ScratchFolder scratch;
  for (const char* name : {"left/1.png", "right/1.png", "right/far/2.png", "masks/1.png",
                           ".thumbs/1.png", "run/renders/1.png", "depth/1.png"}) {
    fs::create_directories((scratch.path() / name).parent_path());
    WritePhoto(scratch.path() / name, 20, 10);
  }
  scratch.Write("run/config.json", "{}");
  const auto files = ListPhotos(scratch.path());
  const PhotoFolder folder = CheckPhotos(files);
  EXPECT_THAT(Names(folder), ElementsAre("left/1.png", "right/1.png", "right/far/2.png"));
  EXPECT_EQ(DescribeSubFolders(files), "");
  // Links are followed, in circles too.
  fs::create_directory_symlink(scratch.path(), scratch.path() / "left/again");
  EXPECT_EQ(ListPhotos(scratch.path()).size(), 3u);
  const ScratchFolder elsewhere;
  WritePhoto(elsewhere.path() / "7.png", 20, 10);
  fs::create_directory_symlink(elsewhere.path(), scratch.path() / "third");
  EXPECT_EQ(ListPhotos(scratch.path()).size(), 4u);
  fs::remove(scratch.path() / "third");
  WritePhoto(scratch.path() / "top.png", 20, 10);
  EXPECT_THAT(
      DescribeSubFolders(ListPhotos(scratch.path())),
      AllOf(HasSubstr("the 1 above them"), HasSubstr("left (1), right (1), right/far (1)")));
}

TEST(PhotoFolder, TheSamePhotographIsUsedOnce) {
  const ScratchFolder scratch;
  const std::string whole = FoxBytes();
  scratch.Write("a.jpg", whole);
  scratch.Write("b.jpg", whole);
  WritePhoto(scratch.path() / "c.png", 20, 10);
  PhotoFolder folder = CheckPhotos(ListPhotos(scratch.path()));
  SkipDuplicates(folder);
  EXPECT_THAT(Names(folder), ElementsAre("a.jpg", "c.png"));
  EXPECT_THAT(SkippedNames(folder), ElementsAre("b.jpg"));
  EXPECT_EQ(folder.skipped[0].reason, "the same file as a.jpg");
  fs::remove(scratch.path() / "c.png");
  folder = CheckPhotos(ListPhotos(scratch.path()));
  EXPECT_THAT(InputErrorOf([&] { SkipDuplicates(folder); }), HasSubstr("all the same file, a.jpg"));
}

TEST(PhotoFolder, ACropIsNoticedByItsExif) {
  const ScratchFolder scratch;
  const auto write = [&](const char* name, int exif_width, int exif_height) {
    OIIO::ImageSpec spec(40, 30, 3, OIIO::TypeUInt8);
    spec.attribute("Exif:PixelXDimension", exif_width);
    spec.attribute("Exif:PixelYDimension", exif_height);
    spec.attribute("FNumber", 2.0f);
    const std::vector<unsigned char> pixels(40 * 30 * 3, static_cast<unsigned char>(exif_width));
    const auto output = OIIO::ImageOutput::create((scratch.path() / name).string());
    ASSERT_TRUE(output && output->open((scratch.path() / name).string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeUInt8, pixels.data()) && output->close());
  };
  write("a-crop.jpg", 80, 40);
  write("b-reduced.jpg", 400, 300);
  write("c-turned.jpg", 30, 40);
  write("d-same.jpg", 40, 30);
  const auto photos = CheckPhotos(ListPhotos(scratch.path())).photos;
  ASSERT_EQ(photos.size(), 4u);
  EXPECT_TRUE(photos[0].cropped_after_exif);
  for (int i = 1; i < 4; ++i) EXPECT_FALSE(photos[i].cropped_after_exif) << photos[i].name;
}

}  // namespace
}  // namespace nerf::sfm
