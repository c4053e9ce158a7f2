#include "nerf/light/spectrum.h"

#include <cmath>

#include "nerf/light/cie_1931.h"

namespace nerf {
namespace {

constexpr double kReference = 560;  // nm; illuminants are normalised there

// Planck's law relative to its value at the reference wavelength.
//   c2  second radiation constant, m K
Spectrum Planck(double kelvin, double c2, double at_reference) {
  const auto law = [&](double nm) {
    const double meters = nm * 1e-9;
    // In the form exp(-x) / (1 - exp(-x)), which does not overflow at low temperatures.
    const double x = c2 / (meters * kelvin);
    return std::pow(nm, -5) * std::exp(-x + c2 / (kReference * 1e-9 * kelvin)) / -std::expm1(-x);
  };
  Spectrum spectrum;
  for (int i = 0; i < Spectrum::kSamples; ++i) {
    spectrum.values[static_cast<std::size_t>(i)] =
        at_reference * law(Spectrum::Wavelength(i)) / law(kReference);
  }
  return spectrum;
}

}  // namespace

Spectrum EqualEnergy() {
  Spectrum spectrum;
  spectrum.values.fill(1);
  return spectrum;
}

Spectrum BlackBody(double kelvin) { return Planck(kelvin, 1.438777e-2, 1); }

Spectrum IlluminantA() { return Planck(2848, 1.435e-2, 100); }

Spectrum Daylight(double kelvin) {
  const double m = 1e3 / kelvin;
  const double x = kelvin <= 7000 ? 0.244063 + 0.09911 * m + 2.9678 * m * m - 4.6070 * m * m * m
                                  : 0.237040 + 0.24748 * m + 1.9018 * m * m - 2.0064 * m * m * m;
  const double y = -3 * x * x + 2.870 * x - 0.275;
  const double scale = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / scale;
  const double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / scale;
  Spectrum spectrum;
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i) {
    const auto& S = DaylightComponents()[i];
    spectrum.values[i] = S[0] + m1 * S[1] + m2 * S[2];
  }
  return spectrum;
}

Eigen::Vector3d XyzFromSpectrum(const Spectrum& spectrum) {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i) {
    const auto& matching = MatchingFunctions()[i];
    xyz += spectrum.values[i] * Spectrum::kStep *
           Eigen::Vector3d(matching[0], matching[1], matching[2]);
  }
  return xyz;
}

Color LinearSrgbFromXyz(const Eigen::Vector3d& xyz) {
  Eigen::Matrix3d srgb_from_xyz;
  srgb_from_xyz << 3.2404542, -1.5371385, -0.4985314,  //
      -0.9692660, 1.8760108, 0.0415560,                //
      0.0556434, -0.2040259, 1.0572252;
  return (srgb_from_xyz * xyz).array();
}

}  // namespace nerf
