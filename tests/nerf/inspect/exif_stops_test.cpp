#include "nerf/inspect/exif_stops.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <map>
#include <string>
#include <vector>

#include "nerf/effects/inspection.h"
#include "nerf/scene/camera.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

// Grey photographs side by side, each with these EXIF entries.
class ExifOfACapture : public testing::Test {
 protected:
  void Add(const std::map<std::string, float>& entries) {
    PosedImage image;
    image.name = fmt::format("{}.jpg", posed_.images.size());
    image.path = folder_.path() / image.name;
    image.world_from_camera = Eigen::Isometry3d::Identity();
    image.world_from_camera.translation().x() = static_cast<double>(posed_.images.size());
    if (posed_.cameras.empty()) posed_.cameras = {PinholeFromFov(8, 8, 1.0)};
    OIIO::ImageSpec spec(8, 8, 3, OIIO::TypeDesc::UINT8);
    for (const auto& [name, value] : entries) spec.attribute(name, value);
    const std::vector<unsigned char> pixels(8 * 8 * 3, 128);
    const auto out = OIIO::ImageOutput::create(image.path.string());
    ASSERT_TRUE(out->open(image.path.string(), spec) &&
                out->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    out->close();
    posed_.images.push_back(image);
  }
  Verdict ExposureVerdict() const {
    for (const Verdict& verdict : Inspect(posed_).verdicts) {
      if (verdict.effect == "exposure") return verdict;
    }
    return {};
  }

  test::ScratchFolder folder_;
  PosedImages posed_;
};

TEST_F(ExifOfACapture, GivesTheExposuresWithoutPoints) {
  for (const float time : {0.01f, 0.02f, 0.04f}) Add({{"ExposureTime", time}});
  EXPECT_THAT(ReadExifStops(posed_).stops,
              ElementsAre(DoubleNear(-1, 1e-3), DoubleNear(0, 1e-3), DoubleNear(1, 1e-3)));
  EXPECT_EQ(Inspect(posed_).stops.size(), 3u);
  EXPECT_TRUE(ExposureVerdict().decided);
  EXPECT_TRUE(ExposureVerdict().on);
}

TEST_F(ExifOfACapture, OfALockedCameraNeedsNoEffect) {
  for (int i = 0; i < 3; ++i) Add({{"ExposureTime", 0.01f}, {"FNumber", 4.0f}});
  EXPECT_TRUE(ExposureVerdict().decided);
  EXPECT_FALSE(ExposureVerdict().on);
}

TEST_F(ExifOfACapture, IsAbsentWhereAPhotographHasNone) {
  Add({{"ExposureTime", 0.01f}});
  Add({});
  EXPECT_TRUE(ReadExifStops(posed_).stops.empty());
  EXPECT_EQ(ReadExifStops(posed_).contradiction, "");
  EXPECT_FALSE(ExposureVerdict().decided);
}

TEST_F(ExifOfACapture, ThatContradictsItselfIsReportedAndNotUsed) {
  Add({{"ExposureTime", 0.01f}});
  Add({{"ExposureTime", 0.02f}, {"Exif:ShutterSpeedValue", 2.0f}});
  const ExifStops exif = ReadExifStops(posed_);
  EXPECT_TRUE(exif.stops.empty());
  EXPECT_THAT(exif.contradiction, HasSubstr("1.jpg: EXIF ExposureTime"));
  EXPECT_EQ(exif.contradiction.find('\n'), std::string::npos);
  EXPECT_EQ(Inspect(posed_).warning, exif.contradiction);
  EXPECT_FALSE(ExposureVerdict().decided);
}

}  // namespace
}  // namespace nerf
