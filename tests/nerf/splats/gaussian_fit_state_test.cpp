#include "nerf/splats/gaussian_fit_state.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nerf {
namespace {

// Gaussian i has i in its mean, and i + 1 percent of opacity.
GaussianFitState StateOf(int count) {
  GaussianCloud cloud(count, 1);
  for (int i = 0; i < count; ++i) {
    const double opacity = 0.01 * (i + 1);
    cloud.At(i, kernels::kMeanRow) = static_cast<float>(i);
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
  for (int i = 0; i < 20; ++i) EXPECT_EQ(state.cloud.At(i, kernels::kMeanRow), 30 + i);
  EXPECT_EQ(state.need.numel(), 32);
  EXPECT_EQ(state.need.sum().item<float>(), 0);
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
