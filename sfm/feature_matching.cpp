#include "sfm/feature_matching.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "nerf/kernels/descriptor_matching.h"

namespace nerf::sfm {
namespace {

constexpr float kLargestAngle = 0.7f;  // radians
constexpr float kLargestRatio = 0.8f;
constexpr float kSquaredLength = 512.0f * 512.0f;

float AngleOf(std::int32_t product) {
  return std::acos(std::min(static_cast<float>(product) / kSquaredLength, 1.0f));
}

bool IsDistinct(const kernels::NearestTwo& nearest) {
  if (nearest.index < 0) return false;
  const float angle = AngleOf(nearest.product);
  return angle <= kLargestAngle && angle < kLargestRatio * AngleOf(nearest.second_product);
}

}  // namespace

Features LargestFeatures(const Features& features, int count) {
  std::vector<int> order(features.positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](int i) { return features.scales[i]; });
  order.resize(std::min<std::size_t>(order.size(), count));
  Features largest;
  for (const int i : order) {
    largest.positions.push_back(features.positions[i]);
    largest.scales.push_back(features.scales[i]);
    const auto* const descriptor =
        &features.descriptors[static_cast<std::size_t>(i) * kernels::kDescriptorSize];
    largest.descriptors.insert(largest.descriptors.end(), descriptor,
                               descriptor + kernels::kDescriptorSize);
  }
  return largest;
}

std::vector<FeatureMatch> MatchFeatures(const Features& first, const Features& second) {
  std::vector<kernels::NearestTwo> of_first(first.Count()), of_second(second.Count());
  kernels::FindNearestTwo(first.descriptors, second.descriptors, of_first, of_second);
  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < of_first.size(); ++i) {
    if (!IsDistinct(of_first[i])) continue;
    const kernels::NearestTwo& back = of_second[of_first[i].index];
    if (back.index != static_cast<int>(i) || !IsDistinct(back)) continue;
    matches.push_back(
        {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(of_first[i].index)});
  }
  return matches;
}

}  // namespace nerf::sfm
