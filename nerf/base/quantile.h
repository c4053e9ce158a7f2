#pragma once

#include <algorithm>
#include <cstddef>
#include <ranges>

namespace nerf {

// Order statistics of unsorted numbers, in linear time. The values are reordered; NaN is invalid.

// The value with a given rank; rank 0 is the smallest. `rank` must be below the number of values.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> ValueOfRank(Values&& values, std::size_t rank) {
  const auto place = std::ranges::begin(values) + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(values, place);
  return *place;
}

// The value with rank floor(q (n - 1)): no interpolation. 0 if there are no values.
//   q  in [0,1]
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> Quantile(Values&& values, double q) {
  const auto count = static_cast<std::size_t>(std::ranges::size(values));
  if (count == 0) return {};
  return ValueOfRank(values, static_cast<std::size_t>(q * static_cast<double>(count - 1)));
}

// The median, for an even number of values the upper of the two in the middle. 0 if there are no
// values.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> UpperMedian(Values&& values) {
  const auto count = static_cast<std::size_t>(std::ranges::size(values));
  if (count == 0) return {};
  return ValueOfRank(values, count / 2);
}

// The median, for an even number of values the mean of the two in the middle. 0 if there are no
// values.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> Median(Values&& values) {
  const auto count = static_cast<std::size_t>(std::ranges::size(values));
  if (count == 0) return {};
  return (ValueOfRank(values, (count - 1) / 2) + ValueOfRank(values, count / 2)) / 2;
}

}  // namespace nerf
