#pragma once

#include "nerf/material/brdf.h"
#include "nerf/material/microfacet.h"

namespace nerf {

// A metallic-roughness material: a matt base under a dielectric, or a metal, whose reflectance is
// the base colour c,
//   f_r = (1 - m) c (1 - F_d(n.l)) (1 - F_d(n.v)) / (pi (1 - mean F_d)) + D G2 F(v.h) / (4 n.l n.v)
//   F(x) = F0 + (1 - F0) (1 - x)^5,  F0 = 0.04 (1 - m) + c m;  F_d the same with F0 = 0.04
// What the dielectric does not reflect enters the base (Kelemen and Szirmay-Kalos 2001, of a smooth
// coat): a white base loses nothing. glTF's (1 - F_d(v.h)) instead reflects up to 1.04 of the light
// at grazing angles. Reciprocal. A metal loses what would be scattered between facets: up to a half
// at alpha 1. Source of the parameters: Burley 2012, "Physically-Based Shading at Disney".
class MetallicRoughness : public Brdf {
 public:
  static constexpr double kDielectricReflectance = 0.04;
  // The mean of F_d over the hemisphere, weighted by the cosine.
  static constexpr double kMeanReflectance =
      kDielectricReflectance + (1 - kDielectricReflectance) / 21;

  //   base_color  in [0,1]
  //   roughness   in [0,1]; alpha = roughness^2, see Ggx
  //   metallic    in [0,1]
  MetallicRoughness(const Color& base_color, double roughness, double metallic);

  Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;
  std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                   const Eigen::Array3d& u) const override;
  double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;

 private:
  // The probability with which Sample follows the facets rather than the base.
  double FacetProbability(double n_dot_v) const;

  Color matt_, F0_;
  Ggx facets_;
};

}  // namespace nerf
