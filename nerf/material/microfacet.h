#pragma once

#include "nerf/material/brdf.h"

namespace nerf {

// A rough surface as a landscape of tiny mirrors: the distribution of their normals h by
// Trowbridge and Reitz 1975 (GGX of Walter et al. 2007), shadowing and masking by Smith,
// height-correlated (Heitz 2014, eq. 99), Fresnel's reflectance by Schlick 1994.
//   alpha  roughness in [kSmoothest, 1]; the width of the lobe. Below kSmoothest a lobe is narrower
//          than rounding in its half vector, so that is the limit for a mirror.
// Arguments stand in the frame of the surface, see Brdf. Finite for every alpha in range and every
// pair of directions, n . v -> 0 too.
class Ggx {
 public:
  static constexpr double kSmoothest = 1e-3;

  explicit Ggx(double alpha);

  // D(h), 1 / sr: integrates with cos(theta_h) to 1.
  double NormalDensity(const Eigen::Vector3d& h) const;
  // G2 / (4 n.l n.v): what a microfacet model multiplies D and F with.
  double Visibility(double n_dot_l, double n_dot_v) const;
  // G1(w): share of the facets towards w that w sees.
  double Masking(double n_dot_w) const;
  // A normal that w_o sees, with density D_v(h) = G1 max(0, w_o . h) D(h) / (n . w_o).
  // Source: Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
  Eigen::Vector3d SampleVisibleNormal(const Eigen::Vector3d& w_o, const Eigen::Array2d& u) const;
  // The density with which mirroring w_o at such a normal gives w_i: D_v(h) / (4 w_o . h), 1 / sr.
  double MirroredPdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const;

 private:
  double alpha_;
};

// F = F0 + (1 - F0) (1 - cos)^5. Source: Schlick 1994.
Color SchlickFresnel(const Color& F0, double cosine);

// A rough metal: f_r = D G2 F / (4 n.l n.v), facets met once (Cook and Torrance 1982).
class Conductor : public Brdf {
 public:
  // F0  reflectance at normal incidence, in [0,1]: the colour of the metal
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
