#include "nerf/material/coated_diffuse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/geometry/directions.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

constexpr int kStrata = 64;  // for a table entry, in each of the two dimensions of visible normals

double Fresnel(double F0, double cosine) { return SchlickFresnel(Color::Constant(F0), cosine).x(); }

// The directional albedo of the facets: the mean of F G2 / G1 over visible normals.
double DirectionalAlbedo(const Ggx& facets, double F0, double n_dot_v) {
  const double mu = std::max(n_dot_v, 1e-6);
  const Vector3d w_o(std::sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (int i = 0; i < kStrata; ++i) {
    for (int j = 0; j < kStrata; ++j) {
      const Eigen::Array2d u((i + 0.5) / kStrata, (j + 0.5) / kStrata);
      const Vector3d h = facets.SampleVisibleNormal(w_o, u);
      const double o_dot_h = w_o.dot(h);
      const Vector3d w_i = 2 * o_dot_h * h - w_o;
      if (w_i.z() <= 0) continue;
      sum += Fresnel(F0, o_dot_h) * facets.Visibility(w_i.z(), mu) * 4 * w_i.z() * mu /
             facets.Masking(mu);
    }
  }
  return sum / (kStrata * kStrata);
}

}  // namespace

CoatedDiffuse::CoatedDiffuse(const Color& albedo, double refractive_index, double alpha)
    : albedo_(albedo),
      F0_(std::pow((refractive_index - 1) / (refractive_index + 1), 2)),
      facets_(alpha) {
  for (int i = 0; i <= kTable; ++i) {
    const double root = static_cast<double>(i) / kTable;
    reflectance_[static_cast<std::size_t>(i)] = DirectionalAlbedo(facets_, F0_, root * root);
  }
  // 2 integral of E(mu) mu dmu; with mu = t^2 the integrand is 4 E t^3 dt. E is interpolated from
  // the table as in Eval, so that energy is conserved exactly.
  constexpr int kSteps = 4096;
  for (int s = 0; s < kSteps; ++s) {
    const double t = (s + 0.5) / kSteps;
    mean_reflectance_ += 4 * CoatReflectance(t * t) * t * t * t / kSteps;
  }
}

double CoatedDiffuse::CoatReflectance(double n_dot_w) const {
  const double position = std::sqrt(std::clamp(n_dot_w, 0.0, 1.0)) * kTable;
  const int i = std::min(static_cast<int>(position), kTable - 1);
  const double* entry = &reflectance_[static_cast<std::size_t>(i)];
  return entry[0] + (entry[1] - entry[0]) * (position - i);
}

Color CoatedDiffuse::Eval(const Vector3d& w_o, const Vector3d& w_i) const {
  if (w_o.z() <= 0 || w_i.z() <= 0) return Color::Zero();
  const Vector3d h = HalfVector(w_o, w_i);
  const double coat =
      Fresnel(F0_, h.dot(w_i)) * facets_.NormalDensity(h) * facets_.Visibility(w_i.z(), w_o.z());
  const double base = (1 - CoatReflectance(w_o.z())) * (1 - CoatReflectance(w_i.z())) /
                      (std::numbers::pi * (1 - mean_reflectance_));
  return coat + albedo_ * base;
}

double CoatedDiffuse::CoatProbability(double n_dot_v) const {
  const double coat = CoatReflectance(n_dot_v);
  const double base = (1 - coat) * Luminance(albedo_);
  return coat / std::max(coat + base, 1e-12);
}

std::optional<BrdfSample> CoatedDiffuse::Sample(const Vector3d& w_o,
                                                const Eigen::Array3d& u) const {
  const auto w_i = FacetsOverBase{facets_, CoatProbability(w_o.z())}.Sample(w_o, u);
  if (!w_i) return std::nullopt;
  return BrdfSample{*w_i, Eval(w_o, *w_i), Pdf(w_o, *w_i)};
}

double CoatedDiffuse::Pdf(const Vector3d& w_o, const Vector3d& w_i) const {
  return FacetsOverBase{facets_, CoatProbability(w_o.z())}.Pdf(w_o, w_i);
}

}  // namespace nerf
