// Files that cannot be read or written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "nerf/image/image_io.h"
#include "tests/support/image_files.h"
#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

using test::GradientImage;
using test::InputErrorOf;
using test::WriteRaw;
using testing::HasSubstr;

class ImageIoErrors : public test::ImageIo {};

void Truncate(const std::filesystem::path& path, double fraction) {
  std::filesystem::resize_file(
      path, static_cast<std::uintmax_t>(fraction *
                                        static_cast<double>(std::filesystem::file_size(path))));
}

TEST_F(ImageIoErrors, ManyChannelsWithoutNamesAreRefused) {
  OIIO::ImageSpec spec(1, 1, 5, OIIO::TypeFloat);
  spec.channelnames = {"a", "b", "c", "d", "e"};
  WriteRaw<float>(File("a.exr"), spec, {1, 2, 3, 4, 5});
  EXPECT_THAT(InputErrorOf([&] { ReadImage(File("a.exr"), false); }),
              testing::AllOf(HasSubstr("a.exr"), HasSubstr("R, G, B")));
}

TEST_F(ImageIoErrors, TruncatedFilesAreRefusedByName) {
  const Image image = GradientImage(90, 701, 3);
  for (const std::string name : {"a.png", "a.jpg", "a.exr"}) {
    for (const double fraction : {0.0, 0.001, 0.1, 0.5, 0.9, 0.99}) {
      WriteImage(File(name), image);
      EXPECT_EQ(ReadImage(File(name), true).width, 90);
      Truncate(File(name), fraction);
      EXPECT_THAT(InputErrorOf([&] { ReadImage(File(name), true); }),
                  HasSubstr(File(name).string()))
          << fraction;
    }
  }
}

TEST_F(ImageIoErrors, BytesAfterTheEndOfAJpegAreIgnored) {
  WriteImage(File("a.jpg"), GradientImage(40, 30, 3));  // phones append videos to their photographs
  std::ofstream(File("a.jpg"), std::ios::app) << std::string(5000, 'x');
  EXPECT_EQ(ReadImage(File("a.jpg"), true).width, 40);
}

TEST_F(ImageIoErrors, NonFiniteValuesAreNamedWithTheirPixel) {
  std::vector<float> values(4 * 3 * 3, 0.5f);
  values[(2 * 4 + 1) * 3 + 1] = std::numeric_limits<float>::quiet_NaN();
  WriteRaw(File("a.exr"), OIIO::ImageSpec(4, 3, 3, OIIO::TypeFloat), values);
  EXPECT_THAT(InputErrorOf([&] { ReadImage(File("a.exr"), false); }),
              testing::AllOf(HasSubstr("a.exr"), HasSubstr("(1, 2)"), HasSubstr("nan")));
}

TEST_F(ImageIoErrors, MissingFilesFoldersAndOtherFilesAreNamed) {
  EXPECT_THAT(InputErrorOf([&] { ReadImage(File("none.png"), false); }), HasSubstr("none.png"));
  EXPECT_THAT(InputErrorOf([&] { ReadImage(File(""), false); }), HasSubstr("not a file"));
  std::ofstream(File("text.png")) << "this is no image";
  EXPECT_THAT(InputErrorOf([&] { ReadImageHeader(File("text.png")); }), HasSubstr("text.png"));
}

TEST_F(ImageIoErrors, AbsurdSizesAreRefusedBeforeTheyAreAllocated) {
  // A BMP header that claims 40,000 x 40,000 pixels, and nothing after it.
  const std::vector<std::uint8_t> header = {
      'B',  'M',  54, 0, 0,    0,    0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0,
      0x40, 0x9c, 0,  0, 0x40, 0x9c, 0, 0, 1, 0, 24, 0, 0, 0, 0,  0, 0, 0,
      0,    0,    0,  0, 0,    0,    0, 0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0};
  std::ofstream(File("a.bmp"), std::ios::binary)
      .write(reinterpret_cast<const char*>(header.data()),
             static_cast<std::streamsize>(header.size()));
  EXPECT_THAT(InputErrorOf([&] { ReadImage(File("a.bmp"), false); }),
              testing::AllOf(HasSubstr("a.bmp"), HasSubstr("40000 x 40000")));
}

TEST_F(ImageIoErrors, WritingReplacesTheFileAndLeavesNothingBeside) {
  WriteImage(File("a.png"), GradientImage(4, 4, 3));
  WriteImage(File("a.png"), GradientImage(5, 4, 1));
  EXPECT_EQ(ReadImage(File("a.png"), false).width, 5);
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(ImageIoErrors, WritingThatFailsLeavesNothing) {
  const Image image = GradientImage(4, 4, 3);
  EXPECT_THAT(InputErrorOf([&] { WriteImage(File("no/a.png"), image); }), HasSubstr("no/a.png"));
  EXPECT_THAT(InputErrorOf([&] { WriteImage(File("a.xyz"), image); }),
              HasSubstr(".png, .jpg or .exr"));
  Image broken = image;
  broken.pixels[5] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(InputErrorOf([&] { WriteImage(File("b.png"), broken); }), HasSubstr("(1, 0)"));
  std::filesystem::create_directories(File("taken.png"));
  EXPECT_THAT(InputErrorOf([&] { WriteImage(File("taken.png"), image); }), HasSubstr("taken.png"));
  EXPECT_EQ(NumFiles(), 1);  // the folder that prevented writing
}

}  // namespace
}  // namespace nerf
