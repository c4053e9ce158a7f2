#pragma once

#include "nerf/image/color.h"

namespace nerf {

// What a translucent material does with light inside it, channel by channel.
struct Medium {
  Color scattering = Color::Constant(1);     // reduced scattering coefficient sigma_s', 1 / length
  Color absorption = Color::Constant(0.01);  // sigma_a, 1 / length
  double refractive_index = 1.3;             // eta, >= 1
};

// Media that were measured, coefficients in 1 / mm. Source: Jensen et al. 2001, figure 5.
Medium MarbleMedium();
Medium WholeMilkMedium();
Medium SkinMedium();

// The same medium where a millimetre is so many units of length.
Medium InUnits(const Medium& in_millimeters, double units_per_millimeter);

// How light that enters a flat translucent surface leaves it again nearby: diffusion, with the
// boundary met by a real light source below the surface and its mirrored, negative twin above.
// Source: Jensen et al. 2001, "A Practical Model for Subsurface Light Transport",
// sections 2.1, 2.2; the second term as in Jensen and Buhler 2002. Single scattering is left out.
//   S_d(x_i, w_i, x_o, w_o) = F_t(w_i) R_d(|x_i - x_o|) F_t(w_o) / pi
class Dipole {
 public:
  explicit Dipole(const Medium& medium);

  // R_d(r), 1 / length^2: radiant exitance at a distance r from where 1 W enters.
  Color DiffuseReflectance(double r) const;
  // 2 pi integral of R_d(r) r dr, in closed form:
  // alpha' / 2 (1 + exp(-4/3 A sqrt(3 (1 - alpha')))) exp(-sqrt(3 (1 - alpha'))).
  Color TotalDiffuseReflectance() const;
  // F_t: share of light that passes the boundary, by Schlick 1994.
  double Transmittance(double n_dot_w) const;

  // 1 / sigma_tr: beyond a few of these lengths nothing comes out.
  Color DiffusionLength() const { return 1 / sigma_tr_; }

 private:
  double F0_;
  double A_;         // of the boundary: (1 + F_dr) / (1 - F_dr)
  Color albedo_;     // alpha' = sigma_s' / sigma_t'
  Color sigma_tr_;   // sqrt(3 sigma_a sigma_t')
  Color z_real_;     // depth of the source
  Color z_virtual_;  // height of its twin
};

}  // namespace nerf
