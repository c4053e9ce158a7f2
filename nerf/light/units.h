#pragma once

#include <cmath>
#include <numbers>

#include "nerf/light/spectrum.h"

namespace nerf {

// Radiometric to photometric units and back: what a lamp's box says, and what a meter says.

inline constexpr double kPlanck = 6.62607015e-34;     // J s, exact (SI 2019)
inline constexpr double kSpeedOfLight = 299792458.0;  // m / s, exact
inline constexpr double kEfficacy = 683.0;            // lm / W at 555 nm (SI: 540 THz)

// Energy of one photon, h c / lambda.
//   nanometers  wavelength
//   returns     joule
inline double PhotonEnergy(double nanometers) {
  return kPlanck * kSpeedOfLight / (nanometers * 1e-9);
}

// Lumens that one watt of light between 380 and 780 nm of this spectrum makes; 0 for no light.
double LuminousEfficacy(const Spectrum& spectrum);

// Luminous flux of radiant flux, and back. Watts are those of the light between 380 and 780 nm.
inline double LumensFromWatts(double watts, const Spectrum& spectrum) {
  return watts * LuminousEfficacy(spectrum);
}
inline double WattsFromLumens(double lumens, const Spectrum& spectrum) {
  return lumens / LuminousEfficacy(spectrum);
}

// Luminous intensity of a lamp alike to all sides, and back: cd = lm / sr.
inline double CandelaFromLumens(double lumens) { return lumens / (4 * std::numbers::pi); }
inline double LumensFromCandela(double candela) { return candela * 4 * std::numbers::pi; }

// The factor of an exposure in stops: each doubles.
inline double FactorFromStops(double stops) { return std::exp2(stops); }

}  // namespace nerf
