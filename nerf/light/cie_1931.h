#pragma once

#include <array>

#include "nerf/light/spectrum.h"

namespace nerf {

// Colour matching functions x, y, z of the CIE 1931 standard observer (2 degrees), at the
// wavelengths of a Spectrum; y is also V, the luminous efficiency of the eye.
// Source: CIE 015:2018, table 5, rounded as in the files of colord.
const std::array<std::array<double, 3>, Spectrum::kSamples>& MatchingFunctions();

// The daylight components S0, S1, S2. Source: CIE 015:2018, table 6 (Judd et al. 1964).
const std::array<std::array<double, 3>, Spectrum::kSamples>& DaylightComponents();

}  // namespace nerf
