#include "nerf/splats/depth_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <utility>

#include "nerf/base/parallel.h"

namespace nerf {
namespace {

using kernels::ProjectedGaussian;

constexpr int kDigitBits = 11, kPasses = 3;
constexpr std::uint32_t kDigits = 1u << kDigitBits;

auto Numbers(const ProjectedGaussian& g) {
  return std::tie(g.x, g.y, g.log2_opacity, g.xx, g.xy, g.yy, g.rgb, g.least);
}

}  // namespace

// A radix sort by the bits of the distances.
std::span<ProjectedGaussian> DepthOrder::Sort(std::span<const ProjectedGaussian> gaussians) {
  const auto count = static_cast<std::uint32_t>(gaussians.size());
  keys_.resize(count);
  other_.resize(count);
  sorted_.resize(count);
  std::array<std::array<std::uint32_t, kDigits>, kPasses> begin{};
  for (std::uint32_t i = 0; i < count; ++i) {
    keys_[i] = {std::bit_cast<std::uint32_t>(gaussians[i].distance), i};
    for (int pass = 0; pass < kPasses; ++pass) {
      ++begin[pass][keys_[i].distance >> (kDigitBits * pass) & (kDigits - 1)];
    }
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    std::uint32_t sum = 0;
    for (std::uint32_t& entry : begin[pass]) entry = std::exchange(sum, sum + entry);
    for (const Key& key : keys_) {
      other_[begin[pass][key.distance >> (kDigitBits * pass) & (kDigits - 1)]++] = key;
    }
    keys_.swap(other_);
  }
  ParallelFor(count, 4096, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) sorted_[i] = gaussians[keys_[i].index];
  });
  for (std::uint32_t i = 0; i < count;) {
    std::uint32_t end = i + 1;
    while (end < count && keys_[end].distance == keys_[i].distance) ++end;
    if (end - i > 1) {
      std::sort(&sorted_[i], &sorted_[i] + (end - i),
                [](const auto& a, const auto& b) { return Numbers(a) < Numbers(b); });
    }
    i = end;
  }
  return sorted_;
}

}  // namespace nerf
