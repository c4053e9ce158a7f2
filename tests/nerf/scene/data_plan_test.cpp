#include "nerf/scene/data_plan.h"

#include <gtest/gtest.h>

#include "nerf/scene/splits.h"
#include "tests/support/numbered_images.h"

namespace nerf {
namespace {

using test::NumberedImages;

// 500 photographs of 12 million pixels.
TEST(PlanData, StoresNoMorePixelsThanFitIntoTheMemory) {
  PosedImages posed = NumberedImages(500);
  posed.cameras[0] = PinholeFromFov(4000, 3000, 1.0);
  AssignSplits(posed, DataOptions());
  DataOptions options;
  const DataPlan plan = PlanData(posed, options);
  EXPECT_EQ(plan.train + plan.validation + plan.held_out, 500);
  EXPECT_EQ(plan.held_out, 63);
  EXPECT_EQ(plan.pixels, 437 * std::int64_t{12'000'000});
  EXPECT_LE(plan.Bytes(), std::int64_t{1} << 30);
  EXPECT_GT(plan.Bytes(), (std::int64_t{1} << 30) - 1000);
  EXPECT_LE(437 * plan.StoredPixelsOf(12'000'000), plan.stored_pixels);
  options.downscale = 40;  // 300 x 225
  const DataPlan small = PlanData(posed, options);
  EXPECT_EQ(small.stored_pixels, small.pixels);
  EXPECT_EQ(small.StoredPixelsOf(300 * 225), 300 * 225);
}

// 1000 x 750 reduced by 4: the last two of 750 rows fill no block.
TEST(PlanData, CountsThePixelsOfDownscaledImages) {
  PosedImages posed = NumberedImages(2);
  posed.cameras[0] = PinholeFromFov(1000, 750, 1.0);
  DataOptions options;
  options.downscale = 4;
  EXPECT_EQ(PlanData(posed, options).pixels, 2 * 250 * 187);
}

}  // namespace
}  // namespace nerf
