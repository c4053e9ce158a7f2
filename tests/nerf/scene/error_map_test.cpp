#include "nerf/scene/error_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/base/random.h"
#include "nerf/scene/camera.h"
#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

View ViewOf(int width, int height) {
  View view;
  view.camera = PinholeFromFov(width, height, 1.0);
  return view;
}

// How often each cell is drawn.
std::vector<int> Draws(const ErrorMap& map, int count) {
  std::vector<int> drawn(map.Errors().size());
  for (int i = 0; i < count; ++i) ++drawn[map.CellOf(map.Draw(Mix64(i)))];
  return drawn;
}

TEST(ErrorMap, DrawsPixelsUniformlyWithoutEstimates) {
  const std::vector<View> views = {ViewOf(20, 17), ViewOf(5, 3)};  // cells of several sizes
  const ErrorMap map(views);
  ASSERT_EQ(map.Errors().size(), 5u);
  std::vector<int> drawn(20 * 17 + 5 * 3);
  constexpr int kEach = 400;
  for (int i = 0; i < kEach * static_cast<int>(drawn.size()); ++i) {
    const ErrorMap::Pixel pixel = map.Draw(Mix64(i));
    ++drawn[(pixel.view == 0 ? 0 : 340) + pixel.index];
  }
  for (const int n : drawn) EXPECT_NEAR(n, kEach, 6 * std::sqrt(kEach));
}

TEST(ErrorMap, DrawsACellInProportionToItsErrorAndSize) {
  const std::vector<View> views = {ViewOf(32, 16), ViewOf(16, 8)};
  ErrorMap map(views);
  map.SetErrors(std::vector<float>{0.03f, 0.01f, 0.12f});  // the last has half as many pixels
  const std::vector<int> drawn = Draws(map, 10000);
  EXPECT_NEAR(drawn[0], 3000, 250);
  EXPECT_NEAR(drawn[1], 1000, 150);
  EXPECT_NEAR(drawn[2], 6000, 250);
}

TEST(ErrorMap, UpdatesTheRunningMeanOfACell) {
  const std::vector<View> views = {ViewOf(32, 16)};
  ErrorMap map(views);
  const std::vector<std::int64_t> cells(100, 1);
  std::vector<float> errors(100);
  for (int i = 0; i < 100; ++i) errors[i] = i % 2 == 0 ? 0.3f : 0.5f;
  map.Update(cells, errors);
  EXPECT_NEAR(map.Errors()[1], 0.4f, 0.02f);
  EXPECT_EQ(map.Errors()[0], -1.0f) << "no estimate";
}

// Corners outside the valid range of the lens never get an estimate; they must not attract rays
// forever.
TEST(ErrorMap, CellsWithoutAnEstimateCountWithTheMeanOfTheOthers) {
  const std::vector<View> views = {ViewOf(64, 16)};  // four cells
  ErrorMap map(views);
  const std::vector<std::int64_t> cells = {1, 2, 3};
  map.Update(cells, std::vector<float>{1e-5f, 2e-5f, 3e-5f});
  EXPECT_NEAR(Draws(map, 8000)[0], 2000, 250);
}

TEST(ErrorMap, OneBrightCellDoesNotTakeAllTheRays) {
  const std::vector<View> views = {ViewOf(32, 16)};
  ErrorMap map(views);
  map.Update(std::vector<std::int64_t>{0, 1}, std::vector<float>{1e9f, 0.25f});
  EXPECT_NEAR(Draws(map, 5000)[1], 1000, 150);
}

TEST(ErrorMap, ConvergedCellsAreStillDrawn) {
  const std::vector<View> views = {ViewOf(32, 16)};
  ErrorMap map(views);
  map.SetErrors(std::vector<float>{0.0f, 0.0f});
  const std::vector<int> drawn = Draws(map, 1000);
  EXPECT_GT(drawn[0], 400);
  EXPECT_GT(drawn[1], 400);
}

TEST(ErrorMap, TakesLargerCellsWherePhotographsAreMany) {
  const std::vector<View> large(40, ViewOf(4000, 3000)), tiny(100000, ViewOf(8, 8));
  EXPECT_LE(ErrorMap(large).Errors().size(), 65536u);
  EXPECT_EQ(ErrorMap(tiny).Errors().size(), tiny.size());
}

TEST(ErrorMap, RefusesTheStateOfOtherPhotographs) {
  const std::vector<View> views = {ViewOf(32, 16)};
  ErrorMap map(views);
  for (const std::vector<float>& errors :
       {std::vector<float>(3), {0.1f, NAN}, {0.1f, -0.5f}, {INFINITY, 0.1f}}) {
    EXPECT_THAT(test::InputErrorOf([&] { map.SetErrors(errors); }),
                testing::HasSubstr("train again"));
  }
}

}  // namespace
}  // namespace nerf
