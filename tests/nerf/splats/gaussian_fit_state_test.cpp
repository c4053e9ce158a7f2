#include "nerf/splats/gaussian_fit_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace nerf {
namespace {

// Gaussian i has i percent in its mean, and i + 1 percent of opacity.
GaussianFitState StateOf(int count) {
  GaussianCloud cloud(count, 1);
  for (int i = 0; i < count; ++i) {
    const double opacity = 0.01 * (i + 1);
    cloud.At(i, kernels::kMeanRow) = 0.01f * static_cast<float>(i);
    cloud.At(i, kernels::kOpacityRow) = static_cast<float>(std::log(opacity / (1 - opacity)));
  }
  GaussianFitState state = BeginFit(cloud);
  state.first_moment.fill_(1);
  state.second_moment.copy_(state.cloud.parameters);
  state.need.fill_(1);
  return state;
}

TEST(GaussianFitState, KeepsThoseThatShowMost) {
  GaussianFitState state = StateOf(50);
  KeepMostVisible(state, 20);
  ASSERT_EQ(state.cloud.count, 20);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(state.cloud.At(i, kernels::kMeanRow), 0.01f * static_cast<float>(30 + i));
  EXPECT_EQ(state.need.numel(), 32);
  EXPECT_EQ(state.need.sum().item<float>(), 0);
}

// A sky is large and shows little; a detail is small and shows much.
TEST(GaussianFitState, KeepsByTheAreaInThePicture) {
  GaussianCloud cloud(4, 0);
  const double distance[] = {1, 500, 1, 500};
  const double size[] = {0.01, 3, 0.02, 8};  // as seen: 0.01, 0.006, 0.02, 0.016
  for (int i = 0; i < 4; ++i) {
    cloud.At(i, kernels::kMeanRow) = static_cast<float>(distance[i]);
    cloud.At(i, kernels::kOpacityRow) = 0;
    for (int k = 0; k < 3; ++k) {
      cloud.At(i, kernels::kLogScaleRow + k) = static_cast<float>(std::log(size[i]));
    }
  }
  GaussianFitState state = BeginFit(Reordered(cloud, {0, 1, 2, 3}));
  KeepMostVisible(state, 2);
  std::vector<double> kept;
  for (int i = 0; i < 2; ++i) kept.push_back(std::exp(state.cloud.At(i, kernels::kLogScaleRow)));
  std::ranges::sort(kept);
  EXPECT_NEAR(kept[0], 0.02, 1e-4);
  EXPECT_NEAR(kept[1], 8, 1e-3);
}

// What fills the last block must not become NaN by a root of its second moment.
TEST(GaussianFitState, KeepsTheirMoments) {
  GaussianFitState state = StateOf(50);
  KeepMostVisible(state, 20);
  const float* const first = state.first_moment.data_ptr<float>();
  const float* const second = state.second_moment.data_ptr<float>();
  for (int i = 0; i < 32; ++i) {
    for (int row = 0; row < kernels::GaussianRows(1); ++row) {
      const std::size_t at = state.cloud.Offset(i, row);
      EXPECT_EQ(first[at], i < 20 ? 1.0f : 0.0f);
      EXPECT_EQ(second[at], i < 20 ? state.cloud.At(i, row) : 0.0f);
    }
  }
}

TEST(GaussianFitState, KeepingMoreThanThereAreKeepsAll) {
  GaussianFitState state = StateOf(50);
  KeepMostVisible(state, 60);
  EXPECT_EQ(state.cloud.count, 50);
}

}  // namespace
}  // namespace nerf
