#include "nerf/material/metallic_roughness.h"

#include <algorithm>
#include <numbers>

#include "nerf/geometry/directions.h"

namespace nerf {

using Eigen::Vector3d;

namespace {

// 1 - F_d: the share of light that enters a dielectric.
double Entering(double cosine) {
  return 1 - SchlickFresnel(Color::Constant(MetallicRoughness::kDielectricReflectance), cosine)[0];
}

}  // namespace

MetallicRoughness::MetallicRoughness(const Color& base_color, double roughness, double metallic)
    : matt_((1 - metallic) * base_color / (std::numbers::pi * (1 - kMeanReflectance))),
      F0_(Color::Constant(kDielectricReflectance * (1 - metallic)) + base_color * metallic),
      facets_(roughness * roughness) {}

Color MetallicRoughness::Eval(const Vector3d& w_o, const Vector3d& w_i) const {
  if (w_o.z() <= 0 || w_i.z() <= 0) return Color::Zero();
  const Vector3d h = HalfVector(w_o, w_i);
  return matt_ * (Entering(w_o.z()) * Entering(w_i.z())) +
         SchlickFresnel(F0_, h.dot(w_i)) *
             (facets_.NormalDensity(h) * facets_.Visibility(w_i.z(), w_o.z()));
}

double MetallicRoughness::FacetProbability(double n_dot_v) const {
  const double reflected = SchlickFresnel(F0_, n_dot_v).mean();
  const double scattered = std::numbers::pi * matt_.mean();
  return reflected / std::max(reflected + scattered, 1e-300);
}

std::optional<BrdfSample> MetallicRoughness::Sample(const Vector3d& w_o,
                                                    const Eigen::Array3d& u) const {
  const auto w_i = FacetsOverBase{facets_, FacetProbability(w_o.z())}.Sample(w_o, u);
  if (!w_i) return std::nullopt;
  return BrdfSample{*w_i, Eval(w_o, *w_i), Pdf(w_o, *w_i)};
}

double MetallicRoughness::Pdf(const Vector3d& w_o, const Vector3d& w_i) const {
  return FacetsOverBase{facets_, FacetProbability(w_o.z())}.Pdf(w_o, w_i);
}

}  // namespace nerf
