#pragma once

namespace nerf {

// Whether a program was compiled without an effect, to measure that one which is off costs nothing
// (scripts/bench --effects): with NERF_LEFT_OUT=Poses or the like, the name of the effect's module
// or options. Where this is true the hook of the effect is a constant that says no.
template <class Effect>
inline constexpr bool kLeftOut = false;
#ifdef NERF_LEFT_OUT
class NERF_LEFT_OUT;
template <>
inline constexpr bool kLeftOut<NERF_LEFT_OUT> = true;
#endif

}  // namespace nerf
