#include "nerf/material/dipole.h"

#include <cmath>
#include <numbers>

#include "nerf/material/microfacet.h"

namespace nerf {
namespace {

using std::numbers::pi;

// Mean reflectance of the boundary for diffuse light from inside.
// Source: Groenhuis et al. 1983, by Jensen et al. 2001.
double DiffuseFresnel(double eta) {
  return -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta;
}

}  // namespace

Medium MarbleMedium() { return {{2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}, 1.5}; }
Medium WholeMilkMedium() { return {{2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}, 1.3}; }
Medium SkinMedium() { return {{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 1.3}; }

Medium InUnits(const Medium& in_millimeters, double units_per_millimeter) {
  Medium medium = in_millimeters;
  medium.scattering /= units_per_millimeter;
  medium.absorption /= units_per_millimeter;
  return medium;
}

Dipole::Dipole(const Medium& medium) {
  const double eta = medium.refractive_index;
  const Color sigma_t = medium.absorption + medium.scattering;
  const double F_dr = DiffuseFresnel(eta);
  F0_ = std::pow((eta - 1) / (eta + 1), 2);
  A_ = (1 + F_dr) / (1 - F_dr);
  albedo_ = medium.scattering / sigma_t;
  sigma_tr_ = (3 * medium.absorption * sigma_t).sqrt();
  z_real_ = 1 / sigma_t;
  z_virtual_ = z_real_ * (1 + 4.0 / 3 * A_);
}

Color Dipole::DiffuseReflectance(double r) const {
  const auto source = [&](const Color& z) -> Color {
    const Color d2 = r * r + z.square();
    const Color d = d2.sqrt();
    return z * (1 + sigma_tr_ * d) * (-sigma_tr_ * d).exp() / (d2 * d);
  };
  return albedo_ / (4 * pi) * (source(z_real_) + source(z_virtual_));
}

Color Dipole::TotalDiffuseReflectance() const {
  const Color root = (3 * (1 - albedo_)).sqrt();
  return albedo_ / 2 * (1 + (-4.0 / 3 * A_ * root).exp()) * (-root).exp();
}

double Dipole::Transmittance(double n_dot_w) const {
  return 1 - SchlickFresnel(Color::Constant(F0_), n_dot_w).x();
}

}  // namespace nerf
