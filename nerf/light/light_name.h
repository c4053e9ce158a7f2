#pragma once

#include <optional>
#include <string_view>

#include "nerf/image/color.h"

namespace nerf {

inline constexpr const char* kLightNames = "D50, D65 (D40 to D250), A, E, blackbody:KELVIN";

// The colour of a light by its name, linear sRGB of unit luminance: the CIE's daylights "D40" to
// "D250" (hundreds of kelvin; D65 is white), incandescent light "A", equal energy "E", a black body
// "blackbody:3200" of 1000 to 100000 K. What lies outside sRGB's gamut (below about 1900 K) is cut
// to it.
//   returns  nullopt where it is no such name
// Throws InputError where the temperature is out of range.
std::optional<Color> ColorOfLight(std::string_view name);

}  // namespace nerf
