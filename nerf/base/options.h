#pragma once

#include <concepts>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace nerf {

// An option is declared once, beside its algorithm:
//
//   struct MarchOptions {
//     double near_distance = 0.05;
//
//     template <class Self, class Visitor>
//     static void Options(Self& o, Visitor&& option) {
//       option("near_distance", o.near_distance, "normalized units", AtLeast(0), "where rays
//       begin");
//     }
//   };
//
// From the declaration and the member's default come JSON, --set, the check of its range,
// `nerf train --help-config` and the table in the docs. A visitor is called in one of these ways:
//   option(name, number, unit, range, help)     unit "" where it has none
//   option(name, enumerator, help)              whose names EnumNames lists
//   option(name, struct, help)                  a block of options
//   option(name, std::optional<struct>, help)   a block that may be null

// The values that a number may take.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_is_open = false, high_is_open = false;
  bool or_zero = false;          // 0 too, which turns something off
  std::vector<double> one_of{};  // these alone; empty: all between low and high

  // Not for NaN and infinities.
  bool Contains(double value) const;
  // "1 to 32", "above 0", "0 or more", "1, 2, 4 or 8".
  std::string Text() const;
};

inline Range Between(double low, double high) { return {low, high}; }
inline Range AtLeast(double low) { return {.low = low}; }
inline Range Above(double low) { return {.low = low, .low_is_open = true}; }
inline Range AboveUpTo(double low, double high) { return {low, high, true, false}; }
inline Range StrictlyBetween(double low, double high) { return {low, high, true, true}; }
inline Range ZeroOr(Range range) {
  range.or_zero = true;
  return range;
}
inline Range OneOf(std::vector<double> values) { return {.one_of = std::move(values)}; }

// The names of an enumeration in configurations, by a specialisation with
//   static constexpr std::pair<T, std::string_view> kNames[]
template <class T>
struct EnumNames;

template <class T>
constexpr std::string_view NameOf(T value) {
  for (const auto& [known, name] : EnumNames<T>::kNames) {
    if (known == value) return name;
  }
  return "";
}

namespace internal {
struct AnyOption {
  template <class... Args>
  void operator()(Args&&...) const {}
};
}  // namespace internal

// A block of options.
template <class T>
concept HasOptions = requires(T& options) {
  T::Options(options, internal::AnyOption());
};

}  // namespace nerf
