#include "nerf/splats/gaussian_fit_state.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "nerf/base/random.h"

namespace nerf {
namespace {

using kernels::kGaussiansInBlock;

constexpr std::uint64_t kSplitStream = 0x67617573735f5f33ull;
// A Gaussian becomes two of this size, a standard deviation of its own apart.
constexpr float kSplitScale = 1 / 1.5f, kSplitDistance = 0.7f;

// A number of mean 0 and variance 1, by the sum of twelve even ones.
float RandomNormal(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  float sum = -6;
  for (std::uint64_t k = 0; k < 12; ++k) sum += RandomFloat(seed, stream, 12 * index + k);
  return sum;
}

// Both are smaller than the one before, and apart by a random vector of its distribution.
void SplitInto(GaussianFitState& state, std::uint64_t seed, std::int64_t from, std::int64_t to) {
  const auto quaternion = [&](int k) { return state.cloud.At(from, kernels::kRotationRow + k); };
  const Eigen::Matrix3f axes =
      Eigen::Quaternionf(quaternion(0), quaternion(1), quaternion(2), quaternion(3))
          .normalized()
          .toRotationMatrix();
  Eigen::Vector3f along;
  for (int k = 0; k < 3; ++k) {
    along[k] = RandomNormal(seed ^ static_cast<std::uint64_t>(state.step), kSplitStream + 2,
                            static_cast<std::uint64_t>(3 * to + k)) *
               std::exp(state.cloud.At(from, kernels::kLogScaleRow + k));
  }
  const Eigen::Vector3f offset = kSplitDistance * (axes * along);
  float* const first = state.first_moment.data_ptr<float>();
  float* const second = state.second_moment.data_ptr<float>();
  for (int row = 0; row < kernels::GaussianRows(state.cloud.order); ++row) {
    float value = state.cloud.At(from, row);
    if (row >= kernels::kLogScaleRow && row < kernels::kRotationRow) value += std::log(kSplitScale);
    state.cloud.At(from, row) = value;
    state.cloud.At(to, row) = value;
    first[state.cloud.Offset(from, row)] = first[state.cloud.Offset(to, row)] = 0;
    second[state.cloud.Offset(to, row)] = second[state.cloud.Offset(from, row)];
  }
  for (int k = 0; k < 3; ++k) {
    state.cloud.At(from, kernels::kMeanRow + k) -= offset[k];
    state.cloud.At(to, kernels::kMeanRow + k) += offset[k];
  }
}

// A measure of how much a Gaussian shows: its opacity times the product of its two longest axes, as
// seen from the distance of its mean, or from 1 unit where it is nearer to the origin.
double Visibility(const GaussianCloud& cloud, std::int64_t i) {
  const auto log_scale = [&](int k) {
    return static_cast<double>(cloud.At(i, kernels::kLogScaleRow + k));
  };
  const double area = std::exp(log_scale(0) + log_scale(1) + log_scale(2) -
                               std::min({log_scale(0), log_scale(1), log_scale(2)}));
  const Eigen::Vector3d mean(cloud.At(i, 0), cloud.At(i, 1), cloud.At(i, 2));
  static_assert(kernels::kMeanRow == 0);
  return area / std::max(1.0, mean.squaredNorm()) /
         (1 + std::exp(-static_cast<double>(cloud.At(i, kernels::kOpacityRow))));
}

// The moments of some Gaussians; 0 of those that only fill the last block.
torch::Tensor MomentsOf(const torch::Tensor& moments, const GaussianCloud& cloud,
                        const std::vector<std::int64_t>& kept) {
  GaussianCloud result(static_cast<std::int64_t>(kept.size()), cloud.order);
  result.parameters.zero_();
  const float* const from = moments.data_ptr<float>();
  for (std::int64_t i = 0; i < result.count; ++i) {
    for (int row = 0; row < kernels::GaussianRows(cloud.order); ++row) {
      result.At(i, row) = from[cloud.Offset(kept[i], row)];
    }
  }
  return result.parameters;
}

}  // namespace

GaussianFitState BeginFit(const GaussianCloud& initial) {
  GaussianCloud cloud = Reordered(initial, SpatialOrder(initial));
  const torch::Tensor& values = cloud.parameters;
  torch::Tensor need = torch::zeros({values.size(0) * kGaussiansInBlock});
  return {cloud, torch::zeros_like(values), torch::zeros_like(values), need, 0};
}

void SplitWhereNeeded(GaussianFitState& state, const SplatOptions& options, std::uint64_t seed) {
  std::vector<std::int64_t> invisible;
  std::vector<double> total;  // running sum of the need of visible ones
  const auto least =
      static_cast<float>(std::log(options.least_opacity / (1 - options.least_opacity)));
  const float* const need = state.need.data_ptr<float>();
  double sum = 0;
  for (std::int64_t i = 0; i < state.cloud.count; ++i) {
    const bool is_visible = state.cloud.At(i, kernels::kOpacityRow) >= least;
    if (!is_visible) invisible.push_back(i);
    sum += is_visible ? static_cast<double>(need[i]) : 0.0;
    total.push_back(sum);
  }
  const auto round = static_cast<std::uint64_t>(state.step);
  std::ranges::sort(invisible, {}, [&](std::int64_t i) {
    return RandomBits(seed ^ round, kSplitStream, static_cast<std::uint64_t>(i));
  });
  const auto most =
      static_cast<std::size_t>(options.split_share * static_cast<double>(state.cloud.count));
  if (invisible.size() > most) invisible.resize(most);
  if (sum > 0) {
    for (const std::int64_t to : invisible) {
      const double drawn = sum * static_cast<double>(RandomFloat(seed ^ round, kSplitStream + 1,
                                                                 static_cast<std::uint64_t>(to)));
      const auto from = std::ranges::upper_bound(total, drawn) - total.begin();
      if (from < state.cloud.count) SplitInto(state, seed, from, to);
    }
  }
  state.need.zero_();
}

void KeepMostVisible(GaussianFitState& state, std::int64_t count) {
  std::vector<double> visibility;
  for (std::int64_t i = 0; i < state.cloud.count; ++i) {
    visibility.push_back(Visibility(state.cloud, i));
  }
  std::vector<std::int64_t> kept(visibility.size());
  std::iota(kept.begin(), kept.end(), 0);
  std::ranges::stable_sort(kept, std::greater<>(), [&](std::int64_t i) { return visibility[i]; });
  kept.resize(static_cast<std::size_t>(std::min(count, state.cloud.count)));
  std::ranges::sort(kept);
  state.first_moment = MomentsOf(state.first_moment, state.cloud, kept);
  state.second_moment = MomentsOf(state.second_moment, state.cloud, kept);
  state.cloud = Reordered(state.cloud, kept);
  state.need = torch::zeros({state.cloud.parameters.size(0) * kGaussiansInBlock});
}

}  // namespace nerf
