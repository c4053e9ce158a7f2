#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "nerf/left_out.h"

namespace nerf {

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

// Where an effect stands in an engine: a std::shared_ptr to its module or a std::optional of its
// options, empty where it is not simulated. In a program compiled without the effect the compiler
// leaves out what stands behind `if (parts.poses)`.
template <class Holder>
struct SlotOf;
template <class Module>
struct SlotOf<std::shared_ptr<Module>> {
  using Type = std::conditional_t<kLeftOut<Module>, EmptySlot<std::shared_ptr<Module>>,
                                  std::shared_ptr<Module>>;
};
template <class Options>
struct SlotOf<std::optional<Options>> {
  using Type = std::conditional_t<kLeftOut<Options>, EmptySlot<std::optional<Options>>,
                                  std::optional<Options>>;
};
template <class Holder>
using Slot = typename SlotOf<Holder>::Type;

}  // namespace nerf
