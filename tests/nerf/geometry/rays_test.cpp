#include "nerf/geometry/rays.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

TEST(CheckCameraCentre, NamesTheViewThatIsTooFarOut) {
  const auto refusal = [](double x) {
    return test::InputErrorOf([&] { CheckCameraCentre({0, x, 0}, "b.jpg"); });
  };
  EXPECT_EQ(refusal(1e8), "no error");
  EXPECT_THAT(refusal(-1e10), testing::HasSubstr("b.jpg: the camera is 1e+10"));
  EXPECT_THAT(refusal(std::numeric_limits<double>::quiet_NaN()), testing::HasSubstr("b.jpg"));
}

TEST(CheckRays, AcceptsValidRaysOnly) {
  RayBatch rays;
  EXPECT_NO_THROW(CheckRays(rays));
  rays.Resize(2);
  rays.direction = {0, 0, 1, 0.6f, 0.8f, 0};
  EXPECT_NO_THROW(CheckRays(rays));
  rays.direction[5] = 0.1f;
  EXPECT_THROW(CheckRays(rays), std::invalid_argument);
}

}  // namespace
}  // namespace nerf
