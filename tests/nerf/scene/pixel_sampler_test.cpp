#include "nerf/scene/pixel_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "nerf/base/parallel.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Two views of different size. The red of a pixel is the index of its view; green and blue are its
// position.
std::vector<View> Views() {
  std::vector<View> views(2);
  for (int v = 0; v < 2; ++v) {
    const int width = 4 + 4 * v, height = 4;
    views[v].camera = PinholeFromFov(width, height, 1.0);
    views[v].normalized_from_camera = Eigen::Isometry3d(Eigen::Translation3d(v, 0, 0));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (const float c : {static_cast<float>(v), x / 16.0f, y / 16.0f, 1.0f}) {
          views[v].rgba.emplace_back(c);
        }
      }
    }
  }
  return views;
}

TEST(PixelSampler, DrawsPixelsUniformlyAndRaysThroughTheirCentres) {
  const std::vector<View> views = Views();
  const TargetBatch batch = PixelSampler(views).Sample(48000, 1, 0);
  std::map<std::array<int, 3>, int> count;
  for (std::int64_t r = 0; r < batch.rays.Size(); ++r) {
    const int v = static_cast<int>(batch.rgb[3 * r]);
    const auto x = static_cast<int>(batch.rgb[3 * r + 1] * 16),
               y = static_cast<int>(batch.rgb[3 * r + 2] * 16);
    ++count[{v, x, y}];
    EXPECT_EQ(batch.rays.origin[3 * r], static_cast<float>(v));
    const auto d = DirectionFromPixel(views[v].camera, {x + 0.5, y + 0.5});
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(batch.rays.direction[3 * r + c], (*d)[c], 1e-6);
    }
  }
  ASSERT_EQ(count.size(), 48u);
  for (const auto& [pixel, n] : count) EXPECT_NEAR(n, 1000, 160);  // five standard deviations
}

TEST(PixelSampler, DrawsDependOnlyOnSeedAndStep) {
  const std::vector<View> views = Views();
  const PixelSampler sampler(views);
  SetNumThreads(1);
  const TargetBatch one = sampler.Sample(500, 7, 3);
  SetNumThreads(3);
  const TargetBatch three = sampler.Sample(500, 7, 3);
  SetNumThreads(AvailableCores());
  EXPECT_EQ(one.rgb, three.rgb);
  EXPECT_EQ(one.rays.jitter, three.rays.jitter);
  EXPECT_NE(one.rgb, sampler.Sample(500, 7, 4).rgb);
  EXPECT_NE(one.rgb, sampler.Sample(500, 8, 3).rgb);
}

TEST(PixelSampler, AShareOfTheRaysIsDrawnByTheErrorMap) {
  const std::vector<View> views = Views();
  PixelSampler sampler(views, 0.5);
  ASSERT_NE(sampler.Errors(), nullptr);
  sampler.Errors()->SetErrors(std::vector<float>{1.0f, 0.0f});  // the first view, a third of pixels
  const TargetBatch batch = sampler.Sample(6000, 1, 0);
  const auto of_first = std::ranges::count(batch.cell, 0);
  EXPECT_NEAR(of_first, 4000, 200);  // its share of one half, all of the other
  for (std::int64_t r = 0; r < batch.rays.Size(); ++r) {
    ASSERT_EQ(batch.cell[r], static_cast<std::int64_t>(batch.rgb[3 * r]));  // red is the view
  }
  EXPECT_EQ(PixelSampler(views).Errors(), nullptr);
  EXPECT_TRUE(PixelSampler(views).Sample(10, 1, 0).cell.empty());
}

TEST(PixelSampler, WhereASubsetOfThePixelsIsStoredOneNearbyIsDrawn) {
  std::vector<View> views = Views();
  for (View& view : views) {
    const auto stored = static_cast<std::int64_t>(view.rgba.size() / 12);  // a third of them
    std::vector<Eigen::half> all = view.rgba;
    view.rgba.resize(4 * stored);
    for (std::int64_t k = 0; k < stored; ++k) {
      std::copy_n(&all[4 * view.PixelIndex(k)], 4, &view.rgba[4 * k]);
    }
  }
  const TargetBatch batch = PixelSampler(views, 1.0).Sample(3000, 1, 0);
  std::set<std::array<int, 3>> seen;
  for (std::int64_t r = 0; r < batch.rays.Size(); ++r) {
    const int v = static_cast<int>(batch.rgb[3 * r]);
    const auto x = static_cast<int>(batch.rgb[3 * r + 1] * 16),
               y = static_cast<int>(batch.rgb[3 * r + 2] * 16);
    seen.insert({v, x, y});
    const auto d = DirectionFromPixel(views[v].camera, {x + 0.5, y + 0.5});
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(batch.rays.direction[3 * r + c], (*d)[c], 1e-6);
  }
  EXPECT_EQ(seen.size(), 15u);  // all that are stored: 16 / 3 and 32 / 3
}

TEST(PixelSampler, TransparentPixelsShowTheRaysBackground) {
  std::vector<View> views = Views();
  for (View& view : views) {
    for (std::size_t i = 3; i < view.rgba.size(); i += 4) view.rgba[i] = Eigen::half(0.0f);
  }
  const TargetBatch batch = PixelSampler(views).Sample(100, 1, 0);
  EXPECT_EQ(batch.rgb, batch.rays.background);
}

TEST(PixelSampler, AShareOfTheRaysIsDrawnAtDepthObservations) {
  std::vector<View> views = Views();
  views[1].depth_observations = {{9, 2.5f}};  // x = 1, y = 1
  const TargetBatch batch = PixelSampler(views, 0, 0.5).Sample(4000, 1, 0);
  std::int64_t at_observation = 0;
  for (std::int64_t r = 0; r < batch.rays.Size(); ++r) {
    if (batch.distance[r] == 0) continue;
    ++at_observation;
    EXPECT_EQ(batch.distance[r], 2.5f);
    EXPECT_EQ(batch.photograph[r], 1);
    EXPECT_EQ(batch.rgb[3 * r + 1], 1 / 16.0f);
    EXPECT_EQ(batch.rgb[3 * r + 2], 1 / 16.0f);
  }
  EXPECT_NEAR(at_observation, 2000, 160);  // five standard deviations
  EXPECT_TRUE(PixelSampler(Views(), 0, 0.5).Sample(10, 1, 0).distance.empty());  // none to draw
}

}  // namespace
}  // namespace nerf
