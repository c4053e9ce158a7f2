#include "sfm/frame_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace nerf::sfm {
namespace {

using testing::ElementsAre;

// Stripes whose edges are ramps of some width.
std::vector<std::uint8_t> Stripes(int ramp) {
  std::vector<std::uint8_t> grey(64 * 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const int within = x % 32;
      const int up = within < 16 ? within : 31 - within;
      grey[static_cast<std::size_t>(y) * 64 + x] =
          static_cast<std::uint8_t>(std::min(255, 255 * up / ramp));
    }
  }
  return grey;
}

TEST(Sharpness, FallsAsEdgesGetSofter) {
  const double sharp = Sharpness(Stripes(1), 64, 64), soft = Sharpness(Stripes(4), 64, 64),
               softer = Sharpness(Stripes(12), 64, 64);
  EXPECT_GT(sharp, 4 * soft);
  EXPECT_GT(soft, 4 * softer);
  EXPECT_EQ(Sharpness(std::vector<std::uint8_t>(64 * 64, 100), 64, 64), 0);
}

TEST(ChooseFrames, TakesTheSharpestOfEachPart) {
  const std::vector<double> sharpness = {1, 5, 2, 4, 4, 6, 3, 2, 1};
  EXPECT_THAT(ChooseFrames(sharpness, 3), ElementsAre(1, 5, 6));
  EXPECT_THAT(ChooseFrames(sharpness, 1), ElementsAre(5));
}

TEST(ChooseFrames, PassesOverWhatIsBlurred) {
  std::vector<double> sharpness(30, 8.0);
  for (int i = 12; i < 18; ++i) sharpness[i] = 0.5;  // the camera swings round
  EXPECT_THAT(ChooseFrames(sharpness, 10), ElementsAre(0, 3, 6, 9, 18, 21, 24, 27));
  // A whole film of smooth surfaces is not blurred.
  EXPECT_EQ(ChooseFrames(std::vector<double>(30, 0.5), 10).size(), 10u);
}

TEST(ChooseFrames, TakesNoFrameTwice) {
  EXPECT_THAT(ChooseFrames(std::vector<double>{3, 3, 3}, 10), ElementsAre(0, 1, 2));
  EXPECT_TRUE(ChooseFrames({}, 10).empty());
}

TEST(DefaultFrameCount, GrowsWithTheLengthWithinLimits) {
  EXPECT_EQ(DefaultFrameCount(5), 40);
  EXPECT_EQ(DefaultFrameCount(30), 90);
  EXPECT_EQ(DefaultFrameCount(3600), 150);
}

}  // namespace
}  // namespace nerf::sfm
