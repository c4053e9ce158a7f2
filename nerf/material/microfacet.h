#pragma once

#include "nerf/material/brdf.h"

namespace nerf {

// The microfacet distribution GGX: normals h by Trowbridge and Reitz 1975 (Walter et al. 2007),
// height-correlated shadowing and masking by Smith (Heitz 2014, eq. 99).
//   alpha  roughness, clamped to [kMinAlpha, 1]. Below kMinAlpha the lobe is narrower than the
//          rounding error of the half vector
// Directions are in the frame of the surface, see Brdf. Finite for all directions, including
// grazing ones.
class Ggx {
 public:
  static constexpr double kMinAlpha = 1e-3;

  explicit Ggx(double alpha);

  // D(h), 1 / sr: integrates with cos(theta_h) to 1.
  double NormalDensity(const Eigen::Vector3d& h) const;
  // G2 / (4 n.l n.v), the factor of D and F in a microfacet BRDF.
  double Visibility(double n_dot_l, double n_dot_v) const;
  // G1(w): the fraction of the facets facing w that are visible from w.
  double Masking(double n_dot_w) const;
  // Draws a normal visible from w_o, with density D_v(h) = G1 max(0, w_o . h) D(h) / (n . w_o).
  // Source: Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
  Eigen::Vector3d SampleVisibleNormal(const Eigen::Vector3d& w_o, const Eigen::Array2d& u) const;
  // The density of the reflection w_i of w_o at such a normal, D_v(h) / (4 w_o . h), 1 / sr.
  double MirroredPdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const;

 private:
  double alpha_;
};

// Directions of light for a coated base: with this probability mirrored at a visible facet, else
// cosine-weighted.
struct FacetsOverBase {
  const Ggx& facets;
  double probability;  // of the facets, in [0,1]

  // A direction above the surface; nullopt: it is below, which counts as a sample of 0.
  std::optional<Eigen::Vector3d> Sample(const Eigen::Vector3d& w_o, const Eigen::Array3d& u) const;
  // The density of Sample, 1 / sr.
  double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const;
};

// F = F0 + (1 - F0) (1 - cos)^5. Source: Schlick 1994.
Color SchlickFresnel(const Color& F0, double cosine);

// A rough metal: f_r = D G2 F / (4 n.l n.v), without multiple scattering between facets.
// Source: Cook and Torrance 1982.
class Conductor : public Brdf {
 public:
  // F0     reflectance at normal incidence, in [0,1]: the colour of the metal
  // alpha  see Ggx
  Conductor(const Color& F0, double alpha) : F0_(F0), facets_(alpha) {}

  Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;
  std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                   const Eigen::Array3d& u) const override;
  double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;

 private:
  Color F0_;
  Ggx facets_;
};

}  // namespace nerf
