#include "nerf/splats/target_pictures.h"

#include <gtest/gtest.h>

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Two pixels, grey and clipped.
View TwoPixels() {
  View view;
  view.camera = PinholeFromFov(2, 1, 0.7);
  for (const float value : {0.5f, 0.5f, 0.5f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f}) {
    view.rgba.push_back(static_cast<Eigen::half>(value));
  }
  return view;
}

TargetPicture WithGains(const std::array<float, 3>& gains) {
  const View view = TwoPixels();
  TargetView target = TargetViewsOf({view}).front();
  target.photograph = &view;
  target.gains = gains;
  return TargetOf(target);
}

TEST(TargetPictures, AreAtTheMeanExposure) {
  const TargetPicture picture = WithGains({2, 1, 0.5f});
  const float expected[] = {0.25f, 0.5f, 1};
  for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(picture.Row(c, 0)[0], expected[c]);
}

TEST(TargetPictures, ClippedPixelsCountLittleWhereTheExposureIsAboveTheMean) {
  const TargetPicture bright = WithGains({1.3f, 1.3f, 1.3f});
  EXPECT_EQ(bright.Row(TargetPicture::kWeight, 0)[0], 1);
  EXPECT_FLOAT_EQ(bright.Row(TargetPicture::kWeight, 0)[1], 0.1f);
  const TargetPicture dark = WithGains({0.7f, 0.7f, 0.7f});
  EXPECT_EQ(dark.Row(TargetPicture::kWeight, 0)[0], 1);
  EXPECT_EQ(dark.Row(TargetPicture::kWeight, 0)[1], 1);
}

}  // namespace
}  // namespace nerf
