#include "nerf/pipeline/training_resolution.h"

#include <gtest/gtest.h>

namespace nerf {
namespace {

TEST(DownscaleFor, KeepsSmallPhotographsAndReducesThoseOfPhones) {
  EXPECT_EQ(DownscaleFor(480, 180), 1);
  EXPECT_EQ(DownscaleFor(640, 30), 1);
  EXPECT_EQ(DownscaleFor(4000, 60), 6);
  EXPECT_EQ(DownscaleFor(4000, 180), 4);
  EXPECT_EQ(DownscaleFor(8000, 3600), 5);  // never more than 1600 pixels
}

TEST(DownscaleFor, FallsWithTheTimeAndGrowsWithThePhotographs) {
  for (int side = 500; side < 8000; side += 100) {
    for (double seconds = 10; seconds < 4000; seconds *= 1.5) {
      EXPECT_GE(DownscaleFor(side, seconds), DownscaleFor(side, 1.5 * seconds));
      EXPECT_LE(DownscaleFor(side, seconds), DownscaleFor(side + 100, seconds));
    }
  }
}

}  // namespace
}  // namespace nerf
