#pragma once

#include <array>

#include "nerf/material/microfacet.h"

namespace nerf {

// A matt base under a rough dielectric: plastic, varnish, glaze. The coat reflects as a microfacet
// surface; what it does not reflect reaches the base and leaves it in all directions:
//   f_r = F D G2 / (4 n.l n.v) + albedo (1 - E(n.v)) (1 - E(n.l)) / (pi (1 - E_mean))
// with E the share of light that the coat reflects by itself, tabulated, and E_mean its mean over
// the cosine-weighted hemisphere. Source: Kelemen and Szirmay-Kalos 2001. Reciprocal; no light is
// made at any roughness, and with a white base none is lost.
class CoatedDiffuse : public Brdf {
 public:
  // albedo            of the base, in [0,1]
  // refractive_index  of the coat, > 1: reflects ((n - 1) / (n + 1))^2 at normal incidence
  // alpha             its roughness, see Ggx
  CoatedDiffuse(const Color& albedo, double refractive_index, double alpha);

  Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;
  std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                   const Eigen::Array3d& u) const override;
  double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;

  // E(n . w): share of the light from w that the coat reflects.
  double CoatReflectance(double n_dot_w) const;

 private:
  static constexpr int kTable = 64;

  double ShareOfCoat(double n_dot_v) const;

  Color albedo_;
  double F0_;
  Ggx facets_;
  std::array<double, kTable + 1> reflectance_;  // at n.w = (i / kTable)^2: dense where it is steep
  double mean_reflectance_ = 0;
};

}  // namespace nerf
