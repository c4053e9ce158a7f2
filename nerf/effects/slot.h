#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace nerf {

// Where an effect stands in an engine: a std::shared_ptr to its module or a std::optional of its
// options, empty where it is not simulated.
//
// That an effect which is off costs nothing is measured (scripts/bench --effects): against engines
// that do not know it, compiled with NERF_LEFT_OUT=Poses or the like. There its slot is a constant
// that says no, and the compiler leaves out what stands behind `if (parts.poses)`.
template <class Holder>
inline constexpr bool kLeftOut = false;
#ifdef NERF_LEFT_OUT
class NERF_LEFT_OUT;
template <>
inline constexpr bool kLeftOut<std::shared_ptr<NERF_LEFT_OUT>> = true;
template <>
inline constexpr bool kLeftOut<std::optional<NERF_LEFT_OUT>> = true;
#endif

// The slot of an effect that is left out: takes anything and holds nothing.
template <class Holder>
struct EmptySlot {
  EmptySlot() = default;
  template <class T>
  EmptySlot(T&&) {}  // NOLINT: as the holder converts
  constexpr explicit operator bool() const { return false; }
  operator Holder() const { return {}; }  // NOLINT
  // Never called, and nowhere to point to.
  auto& operator*() const { return *static_cast<decltype(&*std::declval<Holder&>())>(nullptr); }
  auto* operator->() const { return &**this; }
};

template <class Holder>
using Slot = std::conditional_t<kLeftOut<Holder>, EmptySlot<Holder>, Holder>;

}  // namespace nerf
