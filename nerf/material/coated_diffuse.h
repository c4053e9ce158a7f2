#pragma once

#include <array>

#include "nerf/material/microfacet.h"

namespace nerf {

// A diffuse base under a rough dielectric coat: plastic, varnish, glaze. The coat is a microfacet
// surface; the light that it does not reflect reaches the base, which scatters it diffusely:
//   f_r = F D G2 / (4 n.l n.v) + albedo (1 - E(n.v)) (1 - E(n.l)) / (pi (1 - E_mean))
// E is the directional albedo of the coat, tabulated, and E_mean its cosine-weighted mean over the
// hemisphere. Source: Kelemen and Szirmay-Kalos 2001. Reciprocal; conserves energy at any
// roughness, and loses none if the base is white.
class CoatedDiffuse : public Brdf {
 public:
  // albedo            of the base, in [0,1]
  // refractive_index  of the coat, > 1: reflects ((n - 1) / (n + 1))^2 at normal incidence
  // alpha             roughness of the coat, see Ggx
  CoatedDiffuse(const Color& albedo, double refractive_index, double alpha);

  Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;
  std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                   const Eigen::Array3d& u) const override;
  double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;

  // E(n . w): the fraction of light from w that the coat reflects.
  double CoatReflectance(double n_dot_w) const;

 private:
  static constexpr int kTable = 64;

  // The probability with which Sample follows the coat rather than the base.
  double CoatProbability(double n_dot_v) const;

  Color albedo_;
  double F0_;
  Ggx facets_;
  std::array<double, kTable + 1> reflectance_;  // at n.w = (i / kTable)^2: denser where E is steep
  double mean_reflectance_ = 0;
};

}  // namespace nerf
