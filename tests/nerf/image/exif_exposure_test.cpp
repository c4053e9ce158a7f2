#include "nerf/image/exif_exposure.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

class Exif : public testing::Test {
 protected:
  // A JPEG with these EXIF entries.
  std::optional<ExifExposure> Read(const std::map<std::string, float>& entries) {
    const std::string path = (folder_.path() / "photo.jpg").string();
    OIIO::ImageSpec spec(8, 8, 3, OIIO::TypeDesc::UINT8);
    for (const auto& [name, value] : entries) {
      if (name == "Exif:PhotographicSensitivity") {
        spec.attribute(name, static_cast<int>(value));
      } else {
        spec.attribute(name, value);
      }
    }
    const std::vector<unsigned char> pixels(8 * 8 * 3, 128);
    const auto out = OIIO::ImageOutput::create(path);
    EXPECT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    out->close();
    return ReadExifExposure(path);
  }
  test::ScratchFolder folder_;
};

TEST_F(Exif, GivesTheLightOnTheSensor) {
  const auto one = Read({{"ExposureTime", 0.01f}, {"FNumber", 2.0f}});
  const auto two = Read({{"ExposureTime", 0.02f}, {"FNumber", 4.0f}});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->contradiction, "");
  EXPECT_NEAR(one->stops, std::log2(0.01 / 4), 1e-3);
  EXPECT_NEAR(two->stops - one->stops, -1, 1e-3);  // twice the time, a quarter of the opening
}

TEST_F(Exif, OfAFileWithoutItIsUnknown) {
  EXPECT_FALSE(Read({}));
  EXPECT_FALSE(Read({{"FNumber", 2.0f}}));
  EXPECT_FALSE(ReadExifExposure(folder_.path() / "none.jpg"));
}

TEST_F(Exif, ThatContradictsItselfIsReported) {
  // 1/100 s, and 2^-2 s.
  const auto both = Read({{"ExposureTime", 0.01f}, {"Exif:ShutterSpeedValue", 2.0f}});
  ASSERT_TRUE(both);
  EXPECT_THAT(both->contradiction, testing::HasSubstr("ShutterSpeedValue"));
  const auto rounded = Read({{"ExposureTime", 0.01f}, {"Exif:ShutterSpeedValue", 6.6f}});
  ASSERT_TRUE(rounded);
  EXPECT_EQ(rounded->contradiction, "");
  const auto negative = Read({{"ExposureTime", -1.0f}});
  ASSERT_TRUE(negative);
  EXPECT_THAT(negative->contradiction, testing::HasSubstr("ExposureTime"));
}

}  // namespace
}  // namespace nerf
