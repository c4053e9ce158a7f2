#pragma once

#include <Eigen/Core>
#include <array>

#include "nerf/image/color.h"

namespace nerf {

// A spectral power distribution over the visible range, sampled at 380 to 780 nm every 5 nm. The
// unit, per nanometre, is arbitrary.
struct Spectrum {
  static constexpr int kSamples = 81;
  static constexpr double kFirst = 380;  // nm
  static constexpr double kStep = 5;     // nm

  std::array<double, kSamples> values{};

  static double Wavelength(int i) { return kFirst + kStep * i; }  // nm
};

// Equal energy: 1 at all wavelengths.
Spectrum EqualEnergy();

// A black body, 1 at 560 nm. Source: Planck 1900 with c2 = 0.014388 m K (CODATA).
//   kelvin  above 0
Spectrum BlackBody(double kelvin);

// Standard illuminant A of the CIE, an incandescent lamp, 100 at 560 nm: by definition a black body
// of 2848 K with c2 = 0.01435 m K, which is 2856 K with the current value. Source: CIE 015:2018.
Spectrum IlluminantA();

// Daylight of a correlated colour temperature, 100 at 560 nm. Source: Judd et al. 1964; CIE
// 015:2018, eqs. 4.7 to 4.11. D65 is daylight of 6504 K, because c2 was 0.01438 when it was
// defined.
//   kelvin  4000 to 25000
Spectrum Daylight(double kelvin);

// CIE 1931 tristimulus values: the integrals of the spectrum times x, y, z over wavelength.
Eigen::Vector3d XyzFromSpectrum(const Spectrum& spectrum);

// Linear sRGB from tristimulus values (D65 with Y = 1 is 1 1 1); negative outside the gamut.
// Source: IEC 61966-2-1.
Color LinearSrgbFromXyz(const Eigen::Vector3d& xyz);

}  // namespace nerf
