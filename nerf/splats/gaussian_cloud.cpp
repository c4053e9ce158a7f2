#include "nerf/splats/gaussian_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "nerf/base/quantile.h"

namespace nerf {
namespace {

constexpr float kDead = -20;  // opacity before the sigmoid

// The bits of a number below 2^21, two zeros between each.
std::uint64_t Spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

}  // namespace

GaussianCloud::GaussianCloud(std::int64_t count_in, int order_in)
    : order(order_in), count(count_in) {
  const std::int64_t blocks = (count + kernels::kGaussiansInBlock - 1) / kernels::kGaussiansInBlock;
  parameters = torch::zeros({blocks, kernels::GaussianRows(order), kernels::kGaussiansInBlock});
  for (std::int64_t i = 0; i < blocks * kernels::kGaussiansInBlock; ++i) {
    At(i, kernels::kOpacityRow) = kDead;
    At(i, kernels::kRotationRow) = 1;
  }
}

GaussianParameters GaussianCloud::Parameters() const {
  return {order, {parameters.data_ptr<float>(), static_cast<std::size_t>(parameters.numel())}};
}

std::span<float> GaussianCloud::Values() {
  return {parameters.data_ptr<float>(), static_cast<std::size_t>(parameters.numel())};
}

std::vector<std::int64_t> SpatialOrder(const GaussianCloud& cloud) {
  // Between quantiles, so that a few far ones do not take the resolution.
  std::array<float, 3> low{}, high{};
  for (int k = 0; k < 3; ++k) {
    std::vector<float> coordinates;
    for (std::int64_t i = 0; i < cloud.count; ++i) {
      coordinates.push_back(cloud.At(i, kernels::kMeanRow + k));
    }
    if (coordinates.empty()) break;
    low[k] = Quantile(coordinates, 0.02);
    high[k] = Quantile(coordinates, 0.98);
  }
  std::vector<std::uint64_t> codes;
  for (std::int64_t i = 0; i < cloud.count; ++i) {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
      const float range = std::max(high[k] - low[k], 1e-12f);
      const float part = (cloud.At(i, kernels::kMeanRow + k) - low[k]) / range;
      code |= Spread(static_cast<std::uint64_t>(std::clamp(part, 0.0f, 1.0f) * 1023)) << k;
    }
    codes.push_back(code);
  }
  std::vector<std::int64_t> order(cloud.count);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::int64_t i) { return codes[i]; });
  return order;
}

GaussianCloud Reordered(const GaussianCloud& cloud, const std::vector<std::int64_t>& order) {
  GaussianCloud result(static_cast<std::int64_t>(order.size()), cloud.order);
  const std::span<const float> from = cloud.Parameters().values;
  const std::span<float> to = result.Values();
  for (std::int64_t i = 0; i < result.count; ++i) {
    for (int row = 0; row < kernels::GaussianRows(cloud.order); ++row) {
      to[result.Offset(i, row)] = from[cloud.Offset(order[i], row)];
    }
  }
  return result;
}

}  // namespace nerf
