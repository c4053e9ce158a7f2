#pragma once

#include <cmath>
#include <numbers>

#include "nerf/light/spectrum.h"

namespace nerf {

// Conversions between radiometric and photometric units.

inline constexpr double kPlanck = 6.62607015e-34;     // J s, exact (SI 2019)
inline constexpr double kSpeedOfLight = 299792458.0;  // m / s, exact
inline constexpr double kEfficacy = 683.0;            // lm / W at 555 nm (SI: 540 THz)

// Energy of one photon, h c / lambda.
//   nanometers  wavelength
//   returns     joule
inline double PhotonEnergy(double nanometers) {
  return kPlanck * kSpeedOfLight / (nanometers * 1e-9);
}

// Luminous efficacy of radiation of a spectrum between 380 and 780 nm, lm / W; 0 if it is all 0.
double LuminousEfficacy(const Spectrum& spectrum);

// Luminous flux from radiant flux between 380 and 780 nm, and the inverse.
inline double LumensFromWatts(double watts, const Spectrum& spectrum) {
  return watts * LuminousEfficacy(spectrum);
}
inline double WattsFromLumens(double lumens, const Spectrum& spectrum) {
  return lumens / LuminousEfficacy(spectrum);
}

// Luminous intensity of an isotropic lamp, cd = lm / sr, and the inverse.
inline double CandelaFromLumens(double lumens) { return lumens / (4 * std::numbers::pi); }
inline double LumensFromCandela(double candela) { return candela * 4 * std::numbers::pi; }

// The factor of an exposure in stops, 2^stops.
inline double FactorFromStops(double stops) { return std::exp2(stops); }

}  // namespace nerf
