#include "sfm/colmap_estimate.h"

#include <gtest/gtest.h>

namespace nerf::sfm {
namespace {

TEST(EstimatePoseSeconds, IsWithinAFactorOfTwoOfWhatWasMeasured) {
  const double fox = EstimatePoseSeconds(50, 1920, {}, 2);
  EXPECT_GT(fox, 23 / 2.0);
  EXPECT_LT(fox, 23 * 2.0);
  const double sample = EstimatePoseSeconds(36, 400, {}, 2);
  EXPECT_GT(sample, 4.3 / 2.0);
  EXPECT_LT(sample, 4.3 * 2.0);
}

TEST(EstimatePoseSeconds, GrowsWithThePhotographsAndFallsWithTheThreads) {
  ColmapOptions exhaustive;
  exhaustive.matcher = "exhaustive";
  EXPECT_GT(EstimatePoseSeconds(200, 1920, {}, 2), 4 * EstimatePoseSeconds(50, 1920, {}, 2));
  EXPECT_GT(EstimatePoseSeconds(400, 1920, exhaustive, 2), EstimatePoseSeconds(400, 1920, {}, 2));
  EXPECT_LT(EstimatePoseSeconds(50, 1920, {}, 8), EstimatePoseSeconds(50, 1920, {}, 2) / 2);
}

}  // namespace
}  // namespace nerf::sfm
