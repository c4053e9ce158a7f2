#pragma once

#include <optional>
#include <string_view>

#include "nerf/image/color.h"
#include "nerf/light/spectrum.h"

namespace nerf {

inline constexpr const char* kLightNames = "D50, D65 (D40 to D250), A, E, blackbody:KELVIN";

// The colour of a named light, linear sRGB of luminance 1: the daylights of the CIE, "D40" to
// "D250" (hundreds of kelvin; D65 is white), incandescent light "A", equal energy "E", and black
// bodies of 1000 to 100000 K, "blackbody:3200". Colours outside the gamut of sRGB (below about 1900
// K) are clipped.
//   returns  nullopt if there is no such name
// Throws InputError if the temperature is out of range.
std::optional<Color> ColorOfLight(std::string_view name);

// Its spectrum, in the same cases.
std::optional<Spectrum> SpectrumOfLight(std::string_view name);

}  // namespace nerf
