#include "nerf/splats/target_pictures.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Pixels of one row pair: grey, clipped, grey, and clipped where it is transparent; both rows
// alike.
View Photograph() {
  View view;
  view.camera = PinholeFromFov(4, 2, 0.7);
  for (int row = 0; row < 2; ++row) {
    for (const auto& [value, alpha] : {std::pair(0.5f, 1.0f), std::pair(1.0f, 1.0f),
                                       std::pair(0.5f, 1.0f), std::pair(1.0f, 0.0f)}) {
      for (int c = 0; c < 3; ++c) view.rgba.push_back(static_cast<Eigen::half>(value));
      view.rgba.push_back(static_cast<Eigen::half>(alpha));
    }
  }
  return view;
}

TargetPicture WithGains(const std::array<float, 3>& gains, int halvings = 0) {
  const View view = Photograph();
  TargetView target{&view, view.camera, view.normalized_from_camera, gains};
  return TargetOf(Reduced(target, halvings));
}

std::vector<float> Weights(const TargetPicture& picture) {
  const float* const weight = picture.Row(TargetPicture::kWeight, 0);
  return {weight, weight + picture.width};
}

TEST(TargetPictures, AreAtTheMeanExposure) {
  const TargetPicture picture = WithGains({2, 1, 0.5f});
  const float expected[] = {0.25f, 0.5f, 1};
  for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(picture.Row(c, 0)[0], expected[c]);
}

TEST(TargetPictures, ClippedPixelsCountLittleWhereTheExposureIsAboveTheMean) {
  EXPECT_EQ(Weights(WithGains({1.3f, 1.3f, 1.3f})), std::vector({1.0f, 0.1f, 1.0f, 1.0f}));
  EXPECT_EQ(Weights(WithGains({0.7f, 0.7f, 0.7f})), std::vector(4, 1.0f));
  // At half the resolution the first pixel has a clipped one; its colour is the mean all the same.
  const TargetPicture halved = WithGains({2, 2, 2}, 1);
  EXPECT_EQ(Weights(halved), std::vector({0.1f, 1.0f}));
  EXPECT_NEAR(halved.Row(0, 0)[0], 0.375f, 1e-6f);
}

}  // namespace
}  // namespace nerf
