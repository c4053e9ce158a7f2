#include "nerf/base/options.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace nerf {
namespace {

std::string TextOfNumbers(const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += i + 1 == values.size() ? " or " : ", ";
    text += fmt::format("{:.10g}", values[i]);
  }
  return text;
}

}  // namespace

bool Range::Contains(double value) const {
  if (!std::isfinite(value)) return false;
  if (or_zero && value == 0) return true;
  if (!one_of.empty()) return std::ranges::find(one_of, value) != one_of.end();
  return (low_is_open ? value > low : value >= low) &&
         (high_is_open ? value < high : value <= high);
}

std::string Range::Text() const {
  const std::string zero = or_zero ? "0 or " : "";
  if (!one_of.empty()) return zero + TextOfNumbers(one_of);
  const std::string from = fmt::format("{:.10g}", low), to = fmt::format("{:.10g}", high);
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  if (!has_low && !has_high) return "any number";
  if (!has_high) return zero + (low_is_open ? "above " + from : from + " or more");
  if (!has_low) return zero + (high_is_open ? "below " + to : to + " or less");
  if (low_is_open && high_is_open) return zero + "between " + from + " and " + to + ", exclusive";
  return zero + (low_is_open ? "above " + from + ", at most " + to : from + " to " + to);
}

}  // namespace nerf
