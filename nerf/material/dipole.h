#pragma once

#include "nerf/image/color.h"

namespace nerf {

// Optical properties of a translucent material, for each channel.
struct Medium {
  Color scattering = Color::Constant(1);     // reduced scattering coefficient sigma_s', 1 / length
  Color absorption = Color::Constant(0.01);  // sigma_a, 1 / length
  double refractive_index = 1.3;             // eta, >= 1
};

// Measured media, coefficients in 1 / mm. Source: Jensen et al. 2001, figure 5.
Medium MarbleMedium();
Medium WholeMilkMedium();
Medium SkinMedium();

// The same medium in another unit of length.
Medium InUnits(const Medium& in_millimeters, double units_per_millimeter);

// Subsurface scattering at a flat boundary by diffusion: a real light source below the surface and
// a negative virtual one above it satisfy the boundary condition. Source: Jensen et al. 2001, "A
// Practical Model for Subsurface Light Transport", sections 2.1 and 2.2; the second term as in
// Jensen and Buhler 2002. Single scattering is neglected.
//   S_d(x_i, w_i, x_o, w_o) = F_t(w_i) R_d(|x_i - x_o|) F_t(w_o) / pi
class Dipole {
 public:
  explicit Dipole(const Medium& medium);

  // R_d(r), 1 / length^2: radiant exitance at the distance r from a point where 1 W enters.
  Color DiffuseReflectance(double r) const;
  // 2 pi integral of R_d(r) r dr, in closed form:
  // alpha' / 2 (1 + exp(-4/3 A sqrt(3 (1 - alpha')))) exp(-sqrt(3 (1 - alpha'))).
  Color TotalDiffuseReflectance() const;
  // F_t: the fraction of light that passes the boundary. Source: Schlick 1994.
  double Transmittance(double n_dot_w) const;

  // 1 / sigma_tr: R_d is negligible beyond a few of these lengths.
  Color DiffusionLength() const { return 1 / sigma_tr_; }

 private:
  double F0_;
  double A_;         // boundary term, (1 + F_dr) / (1 - F_dr)
  Color albedo_;     // alpha' = sigma_s' / sigma_t'
  Color sigma_tr_;   // sqrt(3 sigma_a sigma_t')
  Color z_real_;     // depth of the real source
  Color z_virtual_;  // height of the virtual source
};

}  // namespace nerf
